/** The walk so far as a recording: the server has kept it. */

import { asked } from "../net/asked";
import { recordingUrl } from "../net/endpoints";
import { download } from "./film";

/** Hands it over under the scene's name. @throws Error with one sentence for the user */
export async function saveRecording(scene: string): Promise<void> {
  const response = await asked(recordingUrl());
  download(await response.blob(), `${scene.replace(/[^\w-]+/g, "-")}.elbow`);
}
