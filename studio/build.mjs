// Puts the page together: node build.mjs CORE.wasm PAGE.html; prints how large it is.

import { readFileSync, renameSync, writeFileSync } from "node:fs";
import { deflateRawSync } from "node:zlib";
import { build } from "esbuild";

const [wasm, page] = process.argv.slice(2);
const LARGEST = 602_000; // bytes of the whole page
/** Characters of packed bytes: printable ASCII without those that end or escape anything in HTML. */
const DIGITS = Array.from({ length: 94 }, (_, i) => String.fromCharCode(33 + i))
  .filter((digit) => !"<&\\".includes(digit))
  .join("");

async function bundle(entry, format) {
  const { outputFiles } = await build({
    entryPoints: [entry],
    bundle: true,
    minify: true,
    write: false,
    format,
    target: "es2022",
    charset: "utf8",
    legalComments: "eof",
    loader: { ".css": "text" },
    define: { DIGITS: JSON.stringify(DIGITS) },
  });
  // A script must not hold what ends it.
  return outputFiles[0].text.trim().replaceAll("</script", "<\\/script");
}

async function style(...entries) {
  const parts = await Promise.all(
    entries.map((entry) =>
      build({ entryPoints: [entry], bundle: true, minify: true, write: false, charset: "utf8" }),
    ),
  );
  return parts.map(({ outputFiles }) => outputFiles[0].text.trim()).join("");
}

function packed(bytes) {
  return text(deflateRawSync(bytes, { level: 9 }));
}

/** Bytes as text: their number, then 13 or 14 bits, a number below 91 * 91, in two characters; base64 takes a twelfth more. */
function text(bytes) {
  const pairs = [];
  let [bits, width] = [0, 0];
  const write = (pair) => pairs.push(DIGITS[pair % 91] + DIGITS[Math.floor(pair / 91)]);
  for (const byte of bytes) {
    bits |= byte << width;
    width += 8;
    if (width <= 13) continue;
    const taken = (bits & 8191) > 88 ? 13 : 14;
    write(bits & ((1 << taken) - 1));
    bits >>>= taken;
    width -= taken;
  }
  if (width) write(bits);
  return `${bytes.length} ${pairs.join("")}`;
}

const parts = {
  STYLE: await style("uplot/dist/uPlot.min.css", "src/style.css"),
  CORE: packed(readFileSync(wasm)),
  PROGRAM: packed(await bundle("src/main.ts", "iife")),
  BOOT: await bundle("src/boot.ts", "esm"),
};
const html = readFileSync("src/index.html", "utf8").replace(
  /STYLE|CORE|PROGRAM|BOOT/g,
  (name) => parts[name],
);
writeFileSync(`${page}.new`, html);
renameSync(`${page}.new`, page);
await build({
  entryPoints: ["src/node.ts"],
  bundle: true,
  format: "esm",
  platform: "node",
  outfile: "build/node.mjs",
  logLevel: "error",
});
const size = Buffer.byteLength(html);
console.log(`${page}: ${size} bytes; core ${parts.CORE.length}, program ${parts.PROGRAM.length}`);
if (size > LARGEST) {
  console.error(`the page must have at most ${LARGEST} bytes, got ${size}`);
  process.exit(1);
}
