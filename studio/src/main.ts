// The beginning: the page is shown with what it was given.
import { answerOf } from "./answers";
import { Core } from "./core";
import { givenDevice } from "./files";
import { Page } from "./page";
import { fromHash, initialState } from "./state";

/** Shows the page; `wasm` is the core. */
export async function begin(wasm: ArrayBuffer): Promise<void> {
  const core = await Core.load(wasm);
  const given = givenDevice();
  const state = await fromHash(location.hash);
  const page = new Page(core, wasm, state ?? initialState());
  page.mount(document.getElementById("page")!);
  if (given && !state) page.load(given, true);
  window.addEventListener("hashchange", () => {
    void fromHash(location.hash).then((next) => next && page.change(next, ""));
  });
  // For scripts in the console, and tests: the core, and the page with its state.
  Object.assign(globalThis, { pindrive: { core, page, answerOf } });
  document.documentElement.dataset.ready = "";
}
