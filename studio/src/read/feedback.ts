// Reading without eyes: a short tone on the side of each pin that moves the skin, and a short vibration.
import type { Row } from "../input";

const FELT = 0.5; // part of a full change of skin stretch that is announced
const TONE = 0.03; // s
const LOUD = 0.15;
const LOW = 330; // Hz, of the lowest row of pins
const OCTAVES = 1; // from the lowest row to the highest
const SHAKE = 12; // ms
/** Tones at once at most. */
const VOICES = 6;

export const VIBRATES = typeof navigator !== "undefined" && "vibrate" in navigator;

export class Feedback {
  vibration = false;
  private audio: AudioContext | null = null;
  private heard = false;
  private before: boolean[] = [];

  /** Sound begins with the gesture of a person, as browsers ask. */
  set sound(on: boolean) {
    this.heard = on;
    if (on) this.audio ??= new AudioContext();
    if (on) void this.audio?.resume();
  }

  /** Announces the pins whose skin has begun to move. */
  announce(felt: Float64Array, places: readonly Row[]): void {
    const now = Array.from(felt, (part) => part > FELT);
    const begun = now.flatMap((on, pin) => (on && !this.before[pin] ? [pin] : []));
    this.before = now;
    if (!begun.length) return;
    if (this.vibration && VIBRATES) navigator.vibrate(SHAKE);
    if (!this.heard || !this.audio) return;
    const side = Math.max(...places.map(([x]) => Math.abs(x)), 1e-9);
    const high = Math.max(...places.map(([, y]) => Math.abs(y)), 1e-9);
    for (const pin of begun.slice(0, VOICES)) {
      const [x, y] = places[pin]!;
      this.play(x / side, LOW * 2 ** (OCTAVES * 0.5 * (1 - y / high)));
    }
  }

  /** A tone from the left (-1) to the right (1), Hz. */
  private play(pan: number, pitch: number): void {
    const audio = this.audio!;
    const [tone, volume, panner] = [audio.createOscillator(), audio.createGain(), audio.createStereoPanner()];
    tone.frequency.value = pitch;
    panner.pan.value = pan;
    const now = audio.currentTime;
    volume.gain.setValueAtTime(LOUD, now);
    volume.gain.exponentialRampToValueAtTime(1e-3, now + TONE);
    tone.connect(volume).connect(panner).connect(audio.destination);
    tone.start(now);
    tone.stop(now + TONE);
  }
}
