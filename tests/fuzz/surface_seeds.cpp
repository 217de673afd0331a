#include <array>
#include <bit>
#include <cstdint>

#include "seeds.h"

namespace vmesh::testing {
namespace {

const std::string kPlyHead =
    "element vertex 4\nproperty float x\nproperty float y\nproperty float z\nproperty uchar label\n"
    "element face 2\nproperty list uchar int vertex_indices\nproperty float quality\nend_header\n";

template <class T>
std::string bytes(T value) {
  const auto buffer = std::bit_cast<std::array<char, sizeof(T)>>(value);
  return {buffer.begin(), buffer.end()};
}

std::string binary_ply() {
  std::string text = "ply\nformat binary_little_endian 1.0\ncomment SPACE=LPS UNIT=mm\n" + kPlyHead;
  for (const float x : {0.0f, 1.0f, 2.0f, 3.0f}) text += bytes(x) + bytes(x * x) + bytes(1 - x) + '\1';
  for (const int last : {2, 3}) text += '\3' + bytes(std::int32_t{0}) + bytes(1) + bytes(last) + bytes(0.5f);
  return text;
}

/// The most significant byte first.
template <class T>
std::string big_endian(std::initializer_list<T> values) {
  std::string text;
  for (const T value : values) {
    const std::string little = bytes(value);
    text.append(little.rbegin(), little.rend());
  }
  return text;
}

std::string binary_stl() {
  std::string text = "SPACE=LPS UNIT=mm";
  text.resize(80, ' ');
  text += bytes(std::uint32_t{2});
  for (const float x : {0.0f, 1.0f}) {
    for (int i = 0; i < 12; ++i) text += bytes(i % 5 == 0 ? x : static_cast<float>(i % 4));
    text += std::string(2, '\0');
  }
  return text;
}

std::vector<std::string> ply_seeds() {
  return {"ply\nformat ascii 1.0\ncomment SPACE=RAS\n" + kPlyHead +
              "0 0 0 1\n1 0 0 2\n1 1 0 3\n0 1 0.5 4\n4 0 1 2 3 0.25\n3 0 1 3 0.5\n",
          binary_ply(),
          "ply\nformat binary_big_endian 1.0\nobj_info UNIT=um\nelement face 1\n"
          "property list uint8 uint8 vertex_index\nproperty list char short texcoord\nproperty int16 group\n"
          "element vertex 3\nproperty int8 x\nproperty uint8 y\nproperty short z\nproperty ushort q\n"
          "element edge 1\nproperty list uchar double w\nproperty uint32 n\nend_header\n" +
              std::string("\3\0\1\2\1\0\7\0\5"
                          "\1\2\0\3\0\4"
                          "\2\2\0\4\0\5"
                          "\3\1\1\0\0\0"
                          "\0\0\0\0\1",
                          32)};
}

std::vector<std::string> stl_seeds() {
  const std::string facet = "facet normal 0 0 1\n outer loop\n";
  return {"solid SPACE=LPS\n" + facet + "vertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\n" + facet +
              "vertex -0 0 0\nvertex 0 1 0\nvertex 0 0 1e-3\nendloop\nendfacet\nendsolid\n",
          binary_stl()};
}

std::vector<std::string> obj_seeds() {
  return {
      "# SPACE=LPS UNIT=cm\nf 1 2/5 3//7\nv 0 0 0 0.5 0.5 0.5\nv 1 0 0\nv 0 1 0\nvt 0 0\nv 0 0 1\n"
      "f -4/1/1 -1 \\\n -2\nl 1 2\nf 1 1 2\no name\nf 1 2 3 4\n"};
}

std::vector<std::string> off_seeds() {
  return {"OFF\n# SPACE=RAS\n4 2 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 1 2\n4 0 1 3 2 255 0 0\n",
          "COFF 3 1\n0 0 0 1 1 1\n1 0 0\n0 1 0\n\n3 0 1 2\n"};
}

std::vector<std::string> surface_vtk_seeds() {
  const std::string head = "# vtk DataFile Version 4.2\nwall SPACE=LPS\n", kind = "\nDATASET POLYDATA\n";
  return {head + "ASCII" + kind +
              "POINTS 6 float\n0 0 0 2 0 0 2 2 0 1 .5 0\n0 2 0 5 5 5\nLINES 1 3\n2 0 5\n"
              "POLYGONS 2 10\n5 0 1 2 3 4\n3 0 1 5\nTRIANGLE_STRIPS 1 5\n4 0 1 4 5\n"
              "CELL_DATA 4\nSCALARS GroupIds int 1\nLOOKUP_TABLE default\n7 8 9 10\n"
              "POINT_DATA 6\nFIELD f 1\nDistance 1 6 float\n1 2 3 4 5 6\n",
          head + "BINARY" + kind + "POINTS 4 double\n" + big_endian({0., 0., 0., 1., 0., 0., 1., 1., 0., 0., 1., .5}) +
              "\nPOLYGONS 3 4\nOFFSETS vtktypeint64\n" + big_endian<std::int64_t>({0, 4, 4}) +
              "\nCONNECTIVITY vtktypeint64\n" + big_endian<std::int64_t>({0, 1, 2, 3}) + "\nTRIANGLE_STRIPS 1 5\n" +
              big_endian<std::int32_t>({4, 0, 1, 3, 2}) + "\n"};
}

std::vector<std::string> surface_vtp_seeds() {
  return {
      "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\">\n<PolyData>"
      "<FieldData><DataArray type=\"String\" Name=\"UNIT\" NumberOfTuples=\"1\" format=\"ascii\">109 109 0"
      "</DataArray></FieldData><Piece NumberOfPoints=\"5\" NumberOfVerts=\"0\" NumberOfLines=\"0\" "
      "NumberOfStrips=\"1\" NumberOfPolys=\"2\">\n"
      "<PointData Scalars=\"Distance\"><DataArray type=\"Float32\" Name=\"Distance\" format=\"ascii\">1 2 3 4 5"
      "</DataArray><DataArray type=\"Float32\" NumberOfComponents=\"3\" Name=\"Normals\" format=\"ascii\">"
      "0 0 1 0 0 1 0 0 1 0 0 1 0 0 1</DataArray></PointData>\n"
      "<CellData><DataArray type=\"Int32\" Name=\"GroupIds\" format=\"ascii\">1 2 3</DataArray></CellData>\n"
      "<Points><DataArray type=\"Float64\" NumberOfComponents=\"3\" format=\"ascii\">0 0 0 1 0 0 1 1 0 0 1 0 0 2 1"
      "</DataArray></Points>\n"
      "<Strips><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0 1 3 2 4</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">5</DataArray></Strips>\n"
      "<Polys><DataArray type=\"Int64\" Name=\"connectivity\" format=\"ascii\">0 1 2 0 1 2 3</DataArray>"
      "<DataArray type=\"Int64\" Name=\"offsets\" format=\"ascii\">3 7</DataArray></Polys>\n"
      "</Piece></PolyData></VTKFile>\n",
      "<VTKFile type=\"PolyData\" byte_order=\"LittleEndian\" header_type=\"UInt32\"><PolyData>"
      "<Piece NumberOfPoints=\"3\" NumberOfPolys=\"1\"><Points><DataArray type=\"UInt8\" NumberOfComponents=\"3\" "
      "format=\"appended\" offset=\"0\"/></Points><Polys><DataArray type=\"UInt8\" Name=\"connectivity\" "
      "format=\"appended\" offset=\"20\"/><DataArray type=\"UInt8\" Name=\"offsets\" format=\"appended\" "
      "offset=\"32\"/></Polys></Piece></PolyData><AppendedData encoding=\"base64\">_CQAAAAAAAAEAAAABAA=="
      "AwAAAAABAg==AQAAAAM=</AppendedData></VTKFile>"};
}

std::vector<std::string> glb_seeds() {
  const auto word = [](std::size_t value) {
    std::string bytes;
    for (int b = 0; b < 4; ++b) bytes += static_cast<char>(value >> (8 * b) & 0xff);
    return bytes;
  };
  std::string text =
      R"({"asset":{"extras":{"frame":"metres; x to the left, y superior, z anterior; from LPS in mm: (x, z, -y) / 1000"}},
"bufferViews":[{"byteOffset":0,"byteLength":36},{"byteOffset":36,"byteLength":12},{"byteOffset":48,"byteLength":12}],
"accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3"},
{"bufferView":1,"componentType":5126,"count":3,"type":"SCALAR"},{"bufferView":2,"componentType":5125,"count":3,"type":"SCALAR"}],
"meshes":[{"primitives":[{"attributes":{"POSITION":0,"_RADIUS":1},"indices":2}]}],
"nodes":[{"mesh":0,"translation":[0.1,0,0.5]}]})";
  text.resize((text.size() + 3) / 4 * 4, ' ');
  const std::string one("\0\0\x80\x3f", 4), zero(4, '\0');
  const std::string bytes =
      zero + zero + zero + one + zero + zero + zero + one + zero + one + one + one + word(0) + word(1) + word(2);
  return {"glTF" + word(2) + word(28 + text.size() + bytes.size()) + word(text.size()) + "JSON" + text +
          word(bytes.size()) + std::string("BIN\0", 4) + bytes};
}

}  // namespace

std::map<std::string, MakeSeeds> surface_seeds() {
  return {
      {".vtp", surface_vtp_seeds}, {".vtk", surface_vtk_seeds}, {".ply", ply_seeds}, {".stl", stl_seeds},
      {".obj", obj_seeds},         {".off", off_seeds},         {".glb", glb_seeds},
  };
}

}  // namespace vmesh::testing
