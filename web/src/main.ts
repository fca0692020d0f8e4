/** Starts the page, or says in one sentence why it cannot start. */

import { App } from "./app/app";
import { keepPage } from "./keeping_page";
import { readLanguages } from "./preferences";
import { exposeState } from "./probe";
import { words } from "./app/words";
import { speak, text } from "./texts/texts";
import { wordDocument } from "./texts/worded";

speak(readLanguages(new URLSearchParams(location.search)));
wordDocument(document.documentElement);

try {
  exposeState(new App());
  window.addEventListener("load", () => void keepPage());
} catch (error) {
  const message = document.createElement("p");
  message.className = "fatal";
  message.textContent = webglWorks()
    ? text("page.notStarted", words(error))
    : text("page.noWebGl");
  document.body.append(message);
  console.error(error);
}

function webglWorks(): boolean {
  return document.createElement("canvas").getContext("webgl2") !== null;
}
