// Unpacks the page's program, which is compressed beside the core, and begins it.
import type { Begin } from "./main";

async function unpacked(id: string): Promise<Response> {
  const packed = document.getElementById(id)!.textContent!.trim();
  const bytes = Uint8Array.from(atob(packed), (char) => char.charCodeAt(0));
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
