export type Unit = "nm" | "um" | "mm" | "cm" | "m";
export type Space = "LPS" | "RAS";

export interface CenterlineFile {
  /** Its extension tells the format: .swc, .vtp, .json, .csv, .mrk.json ... */
  name: string;
  bytes: Uint8Array | ArrayBuffer | string;
}

export interface ReadOptions {
  /** Of the file; overrides what it says. */
  unit?: Unit;
  space?: Space;
  /** Name of the array, column or property with the radii. */
  radiusArray?: string;
  /** Of all nodes, mm, if the file has none. */
  radius?: number;
}

export interface GenerateOptions {
  /** Vertices around a vessel, 3 to 200; 6. */
  around?: number;
  /** Proven limit on the distance to the vessels, both ways: mm, "0.3mm" or "5%" of the local radius. */
  maxError?: number | string;
  /** Width of the rounding at branches, in smaller radii, 0 to 2; 0.5. */
  blend?: number;
  placement?: "balanced" | "inscribed";
  growth?: "guided" | "paper";
  /** Of vessels that touch; "separate". */
  overlap?: "separate" | "keep";
  /** To be left between them, in smaller radii; 0.1. */
  gap?: number;
  /** How vessels end; "round". */
  ends?: "round" | "flat" | "open";
  /** Length of straight extensions at ends that are not round, in radii. */
  flowExtension?: number;
  /** Share of what edges across vessels cut off by which leaving out nodes may change them, 0 to 1; 0.35. */
  simplification?: number;
  /** Along vessels, triangles at most this times as long as even ones, 1 to 16; 1. */
  elongation?: number;
  ringSpacing?: number;
  leastVertices?: number;
  deformable?: boolean;
  sweeps?: number;
  maxVertices?: number;
}

export interface WriteOptions {
  unit?: Unit;
  space?: Space;
  /** PLY and STL as text. */
  ascii?: boolean;
}

export interface Defect {
  kind: string;
  position: [number, number, number];
  count: number;
  node: number | null;
  message: string;
}

export interface Attribute {
  name: string;
  integer: boolean;
}

/** Where something goes wrong. `name`: InvalidInput, ReadError, Unsupported, Cancelled, OutOfMemory, Error. */
export class VmeshError extends Error {}

export class Centerline {
  readonly nodes: number;
  readonly segments: number;
  readonly components: number;
  readonly loops: number;
  /** What was done to make it valid, and what was assumed. */
  readonly cleaning: string[];
  readonly warnings: string[];
  /** x, y, z and radius of every node, mm, LPS; a copy. */
  nodeArray(): Float64Array;
  /** Two node numbers for every segment; a copy. */
  segmentArray(): Uint32Array;
  free(): void;
}

export class Surface {
  readonly vertices: number;
  readonly faces: number;
  readonly sound: boolean;
  readonly defects: Defect[];
  readonly warnings: string[];
  /** Faces for which maxError is not proven. */
  readonly unprovenFaces: number;
  readonly vertexAttributes: Attribute[];
  readonly faceAttributes: Attribute[];
  /** x, y, z of every vertex, mm, LPS; a copy. */
  vertexArray(): Float64Array;
  /** Three vertex numbers for every face; a copy. */
  faceArray(): Uint32Array;
  /** Values of all vertices, or else of all faces; a copy. */
  attribute(name: string): Float64Array;
  /** The bytes of a file: "ply", "stl", "glb", "obj", "vtp", "off". */
  write(extension: string, options?: WriteOptions): Uint8Array;
  /** What vmesh's page shows, schema vmesh.page/1. */
  page(): unknown;
  free(): void;
}

export class Vmesh {
  readonly version: string;
  /** Extensions. */
  readonly formats: { centerlines: string[]; surfaces: string[] };
  read(files: CenterlineFile | CenterlineFile[], options?: ReadOptions): Centerline;
  /** Takes the thread; `progress` returns false to cancel. */
  generate(centerline: Centerline, options?: GenerateOptions,
    progress?: (stage: string, fraction: number) => boolean | void): Surface;
}

/** `wasm`: the bytes of vmesh.wasm or a compiled module; without it, the file beside vmesh.js. */
export function loadVmesh(wasm?: BufferSource | WebAssembly.Module): Promise<Vmesh>;
export default loadVmesh;
