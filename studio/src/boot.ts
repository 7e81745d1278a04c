// Unpacks the page's program, which is compressed beside the core, and begins it.
import type { Begin } from "./main";

declare const DIGITS: string;

/** The bytes of a text that build.mjs wrote by its function `text`. */
function bytesOf(text: string): Uint8Array<ArrayBuffer> {
  const [length, digits] = text.split(" ") as [string, string];
  const values = new Uint8Array(128);
  for (let i = 0; i < DIGITS.length; ++i) values[DIGITS.charCodeAt(i)] = i;
  const bytes = new Uint8Array(Number(length));
  let [bits, width, count] = [0, 0, 0];
  for (let i = 0; i < digits.length; i += 2) {
    const pair = values[digits.charCodeAt(i)]! + 91 * values[digits.charCodeAt(i + 1)]!;
    bits |= pair << width;
    width += (pair & 8191) > 88 ? 13 : 14;
    for (; width > 7; width -= 8, bits >>>= 8) bytes[count++] = bits & 255;
  }
  return bytes;
}

async function unpacked(id: string): Promise<Response> {
  const bytes = bytesOf(document.getElementById(id)!.textContent!.trim());
  return new Response(new Blob([bytes]).stream().pipeThrough(new DecompressionStream("deflate-raw")));
}

async function boot(): Promise<void> {
  const program = new Blob([await (await unpacked("program")).text()], { type: "text/javascript" });
  const url = URL.createObjectURL(program);
  const wasm = await WebAssembly.compile(await (await unpacked("core")).arrayBuffer());
  await import(url);
  const { begin } = globalThis as unknown as { begin: Begin };
  await begin({ url, wasm });
}

void boot().catch((error: unknown) => {
  document.getElementById("page")!.textContent = `The page cannot begin: ${String(error)}`;
});
