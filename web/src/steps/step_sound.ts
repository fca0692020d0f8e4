/** Quiet steps, made of filtered noise: crisp on the hard floor of a scene, dull on the open field, louder when fast. */

export type GroundKind = "hard" | "soft";

/** How a step sounds. */
export interface StepTone {
  /** 0 to 1 */
  readonly loudness: number;
  /** Of the noise that is left, Hz. */
  readonly pitch: number;
  /** Until it has died away, seconds. */
  readonly length: number;
}

const QUIET = 0.05;
const LOUD = 0.16;
const RUNNING = 2.5;

/** The tone of a step at a speed in m/s. */
export function stepTone(speed: number, ground: GroundKind): StepTone {
  const share = Math.min(1, Math.max(0, speed / RUNNING));
  const soft = ground === "soft";
  return {
    loudness: (soft ? 0.7 : 1) * (QUIET + (LOUD - QUIET) * share),
    pitch: (soft ? 260 : 620) * (1 + 0.5 * share),
    length: (soft ? 0.16 : 0.09) * (1 - 0.25 * share),
  };
}

export class StepSound {
  private context: AudioContext | null = null;
  private noise: AudioBuffer | null = null;
  private left = false;

  /** Lets one step be heard. Browsers are silent until the user has done something. */
  play(speed: number, ground: GroundKind): void {
    const context = (this.context ??= new AudioContext());
    if (context.state === "suspended") void context.resume();
    this.noise ??= noiseOf(context);
    const { loudness, pitch, length } = stepTone(speed, ground);
    const source = new AudioBufferSourceNode(context, { buffer: this.noise, playbackRate: 0.9 + 0.2 * Math.random() });
    const filter = new BiquadFilterNode(context, { type: "bandpass", frequency: pitch, Q: 0.8 });
    const gain = new GainNode(context, { gain: 0 });
    const pan = new StereoPannerNode(context, { pan: this.left ? -0.15 : 0.15 });
    this.left = !this.left;
    const now = context.currentTime;
    gain.gain.setValueAtTime(0, now);
    gain.gain.linearRampToValueAtTime(loudness, now + 0.006);
    gain.gain.exponentialRampToValueAtTime(1e-4, now + length);
    source.connect(filter).connect(gain).connect(pan).connect(context.destination);
    source.start(now, Math.random() * 0.5, length + 0.02);
  }
}

/** A second of noise, so that nothing has to be loaded. */
function noiseOf(context: AudioContext): AudioBuffer {
  const buffer = context.createBuffer(1, context.sampleRate, context.sampleRate);
  const samples = buffer.getChannelData(0);
  for (let i = 0; i < samples.length; i++) samples[i] = 2 * Math.random() - 1;
  return buffer;
}
