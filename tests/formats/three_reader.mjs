// Reads a surface with three.js, which runs without a display: node three_reader.mjs FOLDER_OF_THREE version,
// node three_reader.mjs FOLDER_OF_THREE read FILE [POSE]. Prints JSON.
// POSE is a JSON file: joints by name with position (metres) and quaternion (x, y, z, w). The mesh is then skinned as
// three.js' vertex shader does it (its chunk skinning_vertex), in doubles.
import fs from 'node:fs';
import path from 'node:path';

const [folder, task, file, pose] = process.argv.slice(2);
const part = (name) => import(path.resolve(folder, name));
const THREE = await part('build/three.module.js');
const {MeshoptDecoder} = await part('examples/jsm/libs/meshopt_decoder.module.js');
globalThis.self = globalThis;
console.log = () => {};
const print = (value) => process.stdout.write(JSON.stringify(value));

async function load(loader) {
  return new (await part(`examples/jsm/loaders/${loader}.js`))[loader]();
}

function bytes(path) {
  const content = fs.readFileSync(path);
  return content.buffer.slice(content.byteOffset, content.byteOffset + content.length);
}

// Positions in the world, bent where the mesh has bones.
function points(mesh) {
  const {position, skinIndex, skinWeight} = mesh.geometry.attributes;
  const result = [];
  for (let v = 0; v < position.count; ++v) {
    const p = new THREE.Vector3().fromBufferAttribute(position, v);
    if (mesh.isSkinnedMesh) {
      const bound = p.clone().applyMatrix4(mesh.bindMatrix);
      p.set(0, 0, 0);
      for (let i = 0; i < 4; ++i) {
        const joint = skinIndex.array[4 * v + i];
        const bone = new THREE.Matrix4().fromArray(mesh.skeleton.boneMatrices, 16 * joint);
        p.addScaledVector(bound.clone().applyMatrix4(bone), skinWeight.array[4 * v + i]);
      }
      p.applyMatrix4(mesh.bindMatrixInverse);
    }
    p.applyMatrix4(mesh.matrixWorld);
    result.push(p.x, p.y, p.z);
  }
  return result;
}

// `more`: meshes of further patches, with the same vertices.
function report(mesh, more = []) {
  const geometry = mesh.geometry;
  const attributes = {};
  for (const [name, attribute] of Object.entries(geometry.attributes)) {
    if (attribute.itemSize === 1) attributes[name] = Array.from(attribute.array);
  }
  if (geometry.attributes.color) attributes.color = Array.from(geometry.attributes.color.array);
  const count = geometry.attributes.position.count;
  const faces = geometry.index ? Array.from(geometry.index.array) : Array.from({length: count}, (_, i) => i);
  for (const patch of more) faces.push(...Array.from(patch.geometry.index.array));
  print({points: points(mesh), faces, attributes, bones: mesh.skeleton ? mesh.skeleton.bones.length : 0});
}

function bend(scene, mesh) {
  const joints = JSON.parse(fs.readFileSync(pose, 'utf8')).joints;
  for (const bone of mesh.skeleton.bones) {
    // GLTFLoader makes "_" of blanks in names.
    const joint = joints.find((j) => THREE.PropertyBinding.sanitizeNodeName(j.name) === bone.name);
    const at = new THREE.Vector3().fromArray(joint.position);
    bone.position.copy(bone.parent.worldToLocal(at));
    bone.quaternion.fromArray(joint.quaternion);
  }
}

// Those of an OBJ file: a mesh for each group, none with an index.
function reportGroups(group) {
  const all = {points: [], faces: [], attributes: {}, bones: 0};
  group.updateMatrixWorld(true);
  for (const mesh of group.children) {
    for (const x of points(mesh)) all.points.push(x);
  }
  for (let i = 0; i < all.points.length / 3; ++i) all.faces.push(i);
  print(all);
}

function reportScene(scene) {
  const meshes = [];
  scene.traverse((object) => object.isMesh && meshes.push(object));
  const [first, ...more] = meshes;
  const position = (mesh) => mesh.geometry.attributes.position;
  if (meshes.length === 0 || more.some((mesh) => position(mesh) !== position(first)))
    throw new Error(`${meshes.length} meshes that do not share their vertices`);
  scene.updateMatrixWorld(true);
  if (pose) {
    bend(scene, first);
    scene.updateMatrixWorld(true);
  }
  if (first.isSkinnedMesh) first.skeleton.update();
  report(first, more);
}

if (task === 'version') {
  print(THREE.REVISION);
} else if (file.endsWith('.glb')) {
  const loader = await load('GLTFLoader');
  reportScene((await loader.setMeshoptDecoder(MeshoptDecoder).parseAsync(bytes(file), '')).scene);
} else if (file.endsWith('.obj')) {
  reportGroups((await load('OBJLoader')).parse(fs.readFileSync(file, 'utf8')));
} else {
  const loader = await load(file.endsWith('.stl') ? 'STLLoader' : 'PLYLoader');
  report(new THREE.Mesh(loader.parse(bytes(file))));
}
