// SPDX-License-Identifier: GPL-3.0-or-later
// A workload by Manifold's WebAssembly build (one core), one line of JSON:
//   node manifold.mjs FOLDER_OF_NODE_MODULES FILE      FILE.json and FILE.bin of boundary_evaluate leaves
// Its meshes take vertices as 32-bit floats only; a warp puts the doubles in their place, so that the
// input is that of the other programs. Operators of many operands are its own batch operators. The
// clock runs from its placed leaves to a result with its triangles counted; making them is "load".
import {readFileSync} from 'node:fs';
import {createRequire} from 'node:module';
import {performance} from 'node:perf_hooks';
import {pathToFileURL} from 'node:url';

const [folder, file] = process.argv.slice(2);
const require = createRequire(`${folder}/`);
const {default: Module} = await import(pathToFileURL(require.resolve('manifold-3d/manifold.js')).href);
const wasm = await Module();
wasm.setup();
const {Manifold, Mesh} = wasm;

const {program, leaves, expected} = JSON.parse(readFileSync(`${file}.json`, 'utf8'));
const bytes = readFileSync(`${file}.bin`);
const binary = bytes.buffer.slice(bytes.byteOffset, bytes.byteOffset + bytes.length);

// Vertices that are one float but several doubles stay as they are (there are none in our models).
function exactly(manifold, doubles) {
  const known = new Map();
  const key = (values, i) => `${Math.fround(values[i])} ${Math.fround(values[i + 1])} ${Math.fround(values[i + 2])}`;
  for (let i = 0; i < doubles.length; i += 3) known.set(key(doubles, i), i);
  return manifold.warpBatch((vertices, count) => {
    for (let i = 0; i < 3 * count; i += 3) {
      const from = known.get(key(vertices, i));
      if (from !== undefined) for (let k = 0; k < 3; ++k) vertices[i + k] = doubles[from + k];
    }
  });
}

function leafOf({at, vertices, indices}) {
  const doubles = new Float64Array(binary, at, 3 * vertices);
  const triVerts = new Uint32Array(binary, at + 24 * vertices, indices);
  const mesh = new Mesh({numProp: 3, vertProperties: Float32Array.from(doubles), triVerts});
  return exactly(Manifold.ofMesh(mesh), doubles);
}

// Rows of three by four, to the columns of four by four.
function matrixOf(rows) {
  const matrix = [];
  for (let column = 0; column < 4; ++column) {
    for (let row = 0; row < 3; ++row) matrix.push(rows[4 * row + column]);
    matrix.push(column === 3 ? 1 : 0);
  }
  return matrix;
}

const start = performance.now();
const made = leaves.map(leafOf);
const place = ({leaf, map}) => made[leaf].transform(matrixOf(map));
const placed = program.map((step) => ('leaf' in step ? place(step) : undefined));
for (const leaf of placed) leaf?.numTri();  // transforms are lazy
const load = (performance.now() - start) / 1000;

// Every intermediate result is measured.
function sequence() {
  const cubes = placed.filter((leaf) => leaf !== undefined);
  let solid = cubes[0];
  let error = 0;
  for (let i = 0; i < cubes.length; ++i) {
    if (i > 0) {
      const next = 2 * i < cubes.length ? solid.add(cubes[i]) : solid.subtract(cubes[i]);
      if (i > 1) solid.delete();
      solid = next;
    }
    const [volume, area] = expected[i];
    error = Math.max(error, Math.abs(solid.volume() - volume) / Math.max(1, volume),
                     Math.abs(solid.surfaceArea() - area) / Math.max(1, area));
  }
  return {solid, error};
}

function tree() {
  const values = [];
  program.forEach((step, i) => {
    if (placed[i] !== undefined) {
      values.push(placed[i]);
    } else {
      const operands = values.splice(values.length - step.operands);
      values.push(step.operation === 'union' ? Manifold.union(operands) : Manifold.difference(operands));
    }
  });
  return {solid: values[0]};
}

// As runs_if_one_takes of process_figures.hpp; the first ones also warm up the compiler.
const runsIfOneTakes = (seconds) => (seconds < 1 ? 5 : seconds < 20 ? 2 : 1);
let seconds = Infinity;
let answer, triangles, kilobytes;
for (let run = 0; run === 0 || run < runsIfOneTakes(seconds); ++run) {
  const clock = performance.now();
  answer = expected === undefined ? tree() : sequence();
  triangles = answer.solid.numTri();
  seconds = Math.min(seconds, (performance.now() - clock) / 1000);
  kilobytes ??= process.resourceUsage().maxRSS;
}
const {solid, error} = answer;
const result = {load, seconds, peak_kilobytes: kilobytes, triangles};
if (error === undefined) {
  result.volume = solid.volume();
  result.area = solid.surfaceArea();
} else {
  result.error = error;
}
if (solid.status() !== 'NoError') result.failed = solid.status();
console.log(JSON.stringify(result));
