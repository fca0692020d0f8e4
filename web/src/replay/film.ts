/** Films the picture while it is shown, with the browser's own recorder. */

const TYPES = [
  ["video/mp4;codecs=avc1", "mp4"], ["video/webm;codecs=vp9", "webm"], ["video/webm", "webm"],
] as const;
const FRAMES_PER_SECOND = 30;
const BITS_PER_SECOND = 8_000_000;
const TAIL = 300; // milliseconds that the last picture stays: a slow machine has drawn none other

export class Film {
  private recorder: MediaRecorder | null = null;

  /** Whether this browser records films. */
  static get possible(): boolean {
    return typeof MediaRecorder === "function" && "captureStream" in HTMLCanvasElement.prototype;
  }

  get running(): boolean {
    return this.recorder !== null;
  }

  /** Begins to film a canvas. @param done takes the film when it has ended */
  begin(canvas: HTMLCanvasElement, name: string, done: (film: File) => void): void {
    const [type, ending] = TYPES.find(([kind]) => MediaRecorder.isTypeSupported(kind)) ?? ["", "webm"];
    const stream = canvas.captureStream(FRAMES_PER_SECOND);
    const recorder = new MediaRecorder(stream, { videoBitsPerSecond: BITS_PER_SECOND, ...(type ? { mimeType: type } : {}) });
    const parts: Blob[] = [];
    recorder.addEventListener("dataavailable", ({ data }) => parts.push(data));
    recorder.addEventListener("stop", () => {
      for (const track of stream.getTracks()) track.stop();
      done(new File(parts, `${name}.${ending}`, { type: recorder.mimeType.split(";")[0] ?? "" }));
    });
    recorder.start(1000);
    this.recorder = recorder;
  }

  /** Ends the film with the picture that is there now, and hands it over. */
  end(): void {
    const { recorder } = this;
    this.recorder = null;
    if (!recorder) return;
    for (const track of recorder.stream.getVideoTracks()) (track as CanvasCaptureMediaStreamTrack).requestFrame();
    window.setTimeout(() => recorder.stop(), TAIL);
  }
}

/** Hands a file over as the browser hands over downloads. */
export function download(blob: Blob, name: string): void {
  const link = document.createElement("a");
  link.href = URL.createObjectURL(blob);
  link.download = name;
  link.click();
  window.setTimeout(() => URL.revokeObjectURL(link.href), 60_000);
}
