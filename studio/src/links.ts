// Texts and bytes packed for links, files and the browser's storage.

const UNPACKED = 1 << 26; // bytes that a link or a file may grow to

/** A text as part of a link. */
export async function packedText(text: string): Promise<string> {
  const packed = await deflated(new TextEncoder().encode(text));
  return packed.replaceAll("+", "-").replaceAll("/", "_").replace(/=+$/, "");
}

/** The text in a part of a link. Throws for a part that is cut off or spoiled. */
export async function unpackedText(packed: string): Promise<string> {
  return new TextDecoder().decode(await inflated(packed.replaceAll("-", "+").replaceAll("_", "/")));
}

/** Bytes, compressed, as base64. */
export async function deflated(bytes: Uint8Array): Promise<string> {
  return base64(await piped(bytes, new CompressionStream("deflate-raw")));
}
export async function inflated(text: string): Promise<Uint8Array> {
  return piped(bytesOf(text), new DecompressionStream("deflate-raw"));
}

export function base64(bytes: Uint8Array): string {
  return btoa(Array.from(bytes, (byte) => String.fromCharCode(byte)).join(""));
}
export function bytesOf(text: string): Uint8Array {
  return Uint8Array.from(atob(text), (char) => char.charCodeAt(0));
}

async function piped(
  bytes: Uint8Array,
  through: CompressionStream | DecompressionStream,
): Promise<Uint8Array> {
  const stream = new Blob([bytes as BlobPart]).stream().pipeThrough(through);
  const parts: Uint8Array[] = [];
  let size = 0;
  for (const reader = stream.getReader(); ; ) {
    const { done, value } = await reader.read();
    if (done) return new Uint8Array(await new Blob(parts as BlobPart[]).arrayBuffer());
    parts.push(value);
    size += value.length;
    if (size > UNPACKED) throw new Error(`is larger than ${UNPACKED >> 20} MB`);
  }
}
