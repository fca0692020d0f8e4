/** What build mode asks of the server. All throw an Error with one sentence for the user. */

import type { SceneChoice, UnseenWalk } from "../generated/messages";
import { asked } from "../net/asked";
import { sceneDocumentUrl, scenesUrl, walksUrl } from "../net/endpoints";
import { documentOf, planOf, type SceneDocument } from "./document";
import type { Plan } from "./plan";

/** Hands a scene over, as a plan or as a file says it; where it can be walked in. */
export async function send(scene: Plan | string): Promise<SceneChoice> {
  return (await asked(scenesUrl(), { method: "POST", body: textOf(scene) })).json() as Promise<SceneChoice>;
}

/** The plan of a scene that the server knows. */
export async function fetchPlan(name: string): Promise<Plan> {
  return planOf((await (await asked(sceneDocumentUrl(name))).json()) as SceneDocument);
}

/** Has the avatar walk it unseen. */
export async function walkUnseen(plan: Plan, avatar: string, signal: AbortSignal): Promise<UnseenWalk> {
  return (await asked(walksUrl(avatar), { method: "POST", body: textOf(plan), signal })).json() as Promise<UnseenWalk>;
}

/** The document as text, as it is sent and saved. */
export function textOf(scene: Plan | string): string {
  return typeof scene === "string" ? scene : `${JSON.stringify(documentOf(scene), null, 1)}\n`;
}
