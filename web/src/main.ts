/** Starts the page, or says in one sentence why it cannot start. */

import { App } from "./app/app";
import { keepPage } from "./keeping_page";
import { readLanguages } from "./preferences";
import { exposeState } from "./probe";
import { speak } from "./texts/texts";
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
    ? `The page could not start: ${error instanceof Error ? error.message : String(error)}`
    : "This browser offers no WebGL 2, which the picture needs. Switch on hardware acceleration or try another browser.";
  document.body.append(message);
  console.error(error);
}

function webglWorks(): boolean {
  return document.createElement("canvas").getContext("webgl2") !== null;
}
