// The motion as sound, slowed down: pitch is position, loudness is speed, a click is an event.
import { type Curves, columnAt } from "./sample";

const LASTS = 3; // s
const POINTS = 600;
const [LOW, HIGH] = [220, 880]; // Hz: two octaves from the lowest to the highest position

export class Sound {
  private context: AudioContext | null = null;
  private playing: OscillatorNode | null = null;

  /** Plays a motion up to `end` (s); a second call stops it. `ended` is called at the end of either. */
  toggle(curves: Curves, end: number, ended: () => void): boolean {
    if (this.playing) {
      this.playing.stop();
      return false;
    }
    this.context ??= new AudioContext();
    const { context } = this;
    const times = Array.from({ length: POINTS }, (_, i) => (i * end) / (POINTS - 1));
    const along = (name: "position" | "velocity"): number[] =>
      times.map((time) => columnAt(curves, name, time) || 0);
    const [x, v] = [along("position"), along("velocity").map(Math.abs)];
    const [low, high, fastest] = [Math.min(...x), Math.max(...x), Math.max(...v) || 1];
    const pitch = Float32Array.from(x, (at) => LOW * (HIGH / LOW) ** ((at - low) / (high - low || 1)));
    const loudness = Float32Array.from(v, (speed) => 0.25 * (speed / fastest));
    loudness[POINTS - 1] = 0;
    const [oscillator, gain] = [context.createOscillator(), context.createGain()];
    const now = context.currentTime + 0.05;
    oscillator.type = "triangle";
    oscillator.frequency.setValueCurveAtTime(pitch, now, LASTS);
    gain.gain.setValueAtTime(0, context.currentTime);
    gain.gain.setValueCurveAtTime(loudness, now, LASTS);
    oscillator.connect(gain).connect(context.destination);
    oscillator.start();
    oscillator.stop(now + LASTS);
    for (const { time } of curves.events) if (time <= end) click(context, now + (LASTS * time) / end);
    this.playing = oscillator;
    oscillator.addEventListener("ended", () => {
      this.playing = null;
      ended();
    });
    return true;
  }
}

function click(context: AudioContext, at: number): void {
  const [oscillator, gain] = [context.createOscillator(), context.createGain()];
  oscillator.type = "square";
  oscillator.frequency.value = 1500;
  gain.gain.setValueAtTime(0.15, at);
  gain.gain.exponentialRampToValueAtTime(1e-3, at + 0.03);
  oscillator.connect(gain).connect(context.destination);
  oscillator.start(at);
  oscillator.stop(at + 0.03);
}
