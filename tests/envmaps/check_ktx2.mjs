// KTX2 files as a reader that is not ours sees them: npm's ktx-parse. By hand, in a folder with that package:
//   npm install ktx-parse && node /path/to/tests/envmaps/check_ktx2.mjs FILE.ktx2
// Prints what was read and ends with "good", or throws.
import assert from "node:assert";
import { readFileSync } from "node:fs";
import { createRequire } from "node:module";
import { pathToFileURL } from "node:url";

const { read, VK_FORMAT_R16G16B16A16_SFLOAT } = await import(
  pathToFileURL(createRequire(process.cwd() + "/").resolve("ktx-parse")).href);

function fromHalf(bits) {
  const sign = bits & 0x8000 ? -1 : 1, exponent = (bits >> 10) & 31, mantissa = bits & 1023;
  if (exponent === 31) return mantissa ? NaN : sign * Infinity;
  return sign * (exponent ? 2 ** (exponent - 15) * (1 + mantissa / 1024) : 2 ** -14 * (mantissa / 1024));
}

const file = read(new Uint8Array(readFileSync(process.argv[2])));
assert.equal(file.vkFormat, VK_FORMAT_R16G16B16A16_SFLOAT);
assert.equal(file.faceCount, 6);
assert.equal(file.layerCount, 0);
assert.equal(file.supercompressionScheme, 0);
assert.equal(file.pixelWidth, file.pixelHeight);
const format = file.dataFormatDescriptor[0];
assert.equal(format.colorModel, 1);
assert.equal(format.transferFunction, 1);
assert.equal(format.bytesPlane[0], 8);
assert.deepEqual(format.samples.map((s) => [s.bitOffset, s.bitLength, s.channelType]),
  [[0, 15, 0xc0], [16, 15, 0xc1], [32, 15, 0xc2], [48, 15, 0xcf]]);
const text = (v) => (typeof v === "string" ? v : new TextDecoder().decode(v).replace(/\0$/, ""));
const scale = JSON.parse(text(file.keyValue.nacre)).scale;
assert.equal(text(file.keyValue.KTXorientation), "rd");
console.log(`${file.pixelWidth}² faces, ${file.levels.length} levels, scale ${scale}, ${text(file.keyValue.KTXwriter)}`);
file.levels.forEach((level, i) => {
  const edge = Math.max(1, file.pixelWidth >> i);
  assert.equal(level.levelData.byteLength, 6 * 8 * edge * edge);
  const data = new DataView(level.levelData.buffer, level.levelData.byteOffset, level.levelData.byteLength);
  const sum = [0, 0, 0];
  let weights = 0;
  for (let t = 0; t < 6 * edge * edge; t++) {
    const a = (2 * (t % edge) + 1) / edge - 1, b = (2 * (Math.floor(t / edge) % edge) + 1) / edge - 1;
    const weight = (1 + a * a + b * b) ** -1.5;
    weights += weight;
    for (let c = 0; c < 4; c++) {
      const value = fromHalf(data.getUint16(8 * t + 2 * c, true));
      assert(Number.isFinite(value));
      if (c === 3) assert.equal(value, 1);
      else sum[c] += weight * value * scale;
    }
  }
  console.log(`level ${i}: ${edge}², mean radiance ${sum.map((s) => (s / weights).toPrecision(4)).join(" ")}`);
});
console.log("good");
