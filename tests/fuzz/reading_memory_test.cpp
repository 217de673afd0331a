// Reading a file takes at most a multiple of its size in memory, whatever its content claims.
#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

#include <gtest/gtest.h>
#include <malloc.h>

#include "vmesh/image/image_slices.h"

#include "../image/image_files.h"
#include "readers.h"

namespace {

std::atomic<std::size_t> live{0}, peak{0};

void* counted(void* block) {
  if (!block) throw std::bad_alloc();
  const std::size_t now = live += malloc_usable_size(block);
  for (std::size_t seen = peak; seen < now && !peak.compare_exchange_weak(seen, now);) {
  }
  return block;
}

void release(void* block) noexcept {
  if (block) live -= malloc_usable_size(block);
  std::free(block);
}

}  // namespace

void* operator new(std::size_t size) { return counted(std::malloc(size)); }
void* operator new[](std::size_t size) { return counted(std::malloc(size)); }
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {
  void* block = std::malloc(size);
  return block ? counted(block) : nullptr;
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  const auto step = static_cast<std::size_t>(alignment);
  return counted(std::aligned_alloc(step, (size + step - 1) / step * step));
}
void operator delete(void* block) noexcept { release(block); }
void operator delete[](void* block) noexcept { release(block); }
void operator delete(void* block, std::size_t) noexcept { release(block); }
void operator delete[](void* block, std::size_t) noexcept { release(block); }
void operator delete(void* block, const std::nothrow_t&) noexcept { release(block); }
void operator delete(void* block, std::align_val_t) noexcept { release(block); }
void operator delete(void* block, std::size_t, std::align_val_t) noexcept { release(block); }

namespace vmesh::testing {
namespace {

// As centerline_io.h, surface_io.h and image_io.h state it.
constexpr std::size_t kMostPerByte = 128, kMostPerUnpackedByte = 16, kRoom = 1 << 20;
constexpr std::size_t kSize = 1 << 20;

/// Bytes on the heap at a time while the reader works, beyond those before.
std::size_t peak_while_reading(const Reader& reader, const std::string& content) {
  const std::size_t before = live;
  peak = before;
  reader.read(content);
  return peak - before;
}

void expect_bounded(const char* reader, const std::string& content) {
  const std::size_t most = kMostPerByte * content.size() + kRoom;
  EXPECT_LE(peak_while_reading(reader_named(reader), content), most)
      << reader << ", " << content.size() << " bytes: " << content.substr(0, 80);
}

/// `head`, then `unit` again and again up to kSize bytes, then `tail`.
std::string many(const std::string& unit, const std::string& head = "", const std::string& tail = "") {
  std::string text = head;
  while (text.size() + unit.size() + tail.size() <= kSize) text += unit;
  return text + tail;
}

/// The same with the number of the unit in it where a % stands.
std::string numbered(const std::string& unit, const std::string& head = "", const std::string& tail = "") {
  std::string text = head;
  const std::size_t place = unit.find('%');
  for (int i = 1; text.size() + unit.size() + 20 + tail.size() <= kSize; ++i) {
    text.append(unit, 0, place).append(std::to_string(i)).append(unit, place + 1);
  }
  return text + tail;
}

const std::string kLie = "353535235358";

/// Of a spatial graph with as many of everything.
std::string amira_head(const std::string& count, const std::string& packing = "", const std::string& kind = "ASCII") {
  return "# AmiraMesh " + kind + " 2.0\ndefine VERTEX " + count + "\ndefine EDGE " + count + "\ndefine POINT " + count +
         "\nVERTEX { float[3] VertexCoordinates } @1" + packing +
         "\nEDGE { int[2] EdgeConnectivity } @2\nEDGE { int NumEdgePoints } @3\nPOINT { float[3] EdgePointCoordinates "
         "} @4\n"
         "POINT { float Radius } @5\n";
}

TEST(ReadingMemory, HeadersThatLieAreErrors) {
  const std::string vtp_head = "<VTKFile type=\"PolyData\"><PolyData><Piece NumberOfPoints=\"";
  const std::string cells = "<Points><DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0</DataArray></Points>";
  const std::string offsets =
      "<DataArray type=\"Int64\" Name=\"offsets\">1</DataArray>"
      "<DataArray type=\"Int64\" Name=\"connectivity\">0</DataArray>";
  const std::string end = "</Piece></PolyData></VTKFile>";
  const std::string vtk_head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS ";
  const std::string stl_head(80, ' ');
  const SampleImage image;
  std::string nifti = nifti_file<std::int16_t>(image, image.values());
  for (int a = 0; a < 3; ++a) nifti.replace(42 + 2 * a, 2, "\xff\x7f");
  const std::string huge = "sizes: 353535235358 7 5\n";
  const std::pair<const char*, std::string> lies[] = {
      {"vmv", "$PARAM_BEGIN\n$NUM_VERTS " + kLie + "\n$PARAM_END\n"},
      {"vtk", vtk_head + kLie + " float\n0 0 0\n"},
      {"vtk", vtk_head + "1 float\n0 0 0\nLINES " + kLie + " " + kLie + "\n"},
      {"vtk", vtk_head + "1 float\n0 0 0\nLINES 1 2\n" + kLie + " 0\n"},
      {"vtk", "# vtk DataFile Version 3.0\nt\nBINARY\nDATASET POLYDATA\nPOINTS " + kLie + " float\nabc\n"},
      {"am", amira_head(kLie) + "@1\n0 0 0\n"},
      {"am", amira_head("3", "(HxZip,9)", "BINARY") + "@1\nabcdefghi\n"},
      {"tre", "ObjectType=Tube\nPointDim=x y z r\nNPoints=" + kLie + "\nPoints=\n0 0 0 1\n"},
      {"tre", "ObjectType=Tube\nPointDim=x y z r\nBinaryData=T\nNPoints=" + kLie + "\nPoints=\nabcd"},
      {"dat", "t\n1 1 1\n1 1 1\n1\n1\n1\n" + kLie + "\nhead\n1 5 1 2 9\n"},
      {"vtp",
       vtp_head + kLie + "\"><Points><DataArray NumberOfComponents=\"3\" type=\"Int8\">0</DataArray></Points>" + end},
      {"vtp", vtp_head + "1\" NumberOfLines=\"" + kLie + "\">" + cells + "<Lines>" + offsets + "</Lines>" + end},
      {"vtp",
       "<VTKFile type=\"PolyData\" header_type=\"UInt64\"><PolyData><Piece NumberOfPoints=\"1\"><Points><DataArray "
       "type=\"Int8\" NumberOfComponents=\"3\" format=\"binary\">////////////////</DataArray></Points>" +
           end},
      {"vtp",
       "<VTKFile type=\"PolyData\" compressor=\"vtkZLibDataCompressor\"><PolyData><Piece NumberOfPoints=\"1\">"
       "<Points><DataArray type=\"Int8\" NumberOfComponents=\"3\" format=\"binary\">////////////////////////"
       "</DataArray></Points>" +
           end},
      {"vtp",
       "<VTKFile type=\"PolyData\" compressor=\"vtkZLibDataCompressor\"><PolyData><Piece NumberOfPoints=\"1\">"
       "<Points><DataArray type=\"Int8\" NumberOfComponents=\"3\" format=\"binary\">AQAAAP///////////wAAAA=="
       "</DataArray></Points>" +
           end},
      {"surface_vtp",
       vtp_head + "1\" NumberOfPolys=\"" + kLie + "\">" + cells + "<Polys>" + offsets + "</Polys>" + end},
      {"surface_ply", "ply\nformat binary_little_endian 1.0\nelement vertex " + kLie +
                          "\nproperty float x\nproperty float y\nproperty float z\nend_header\n"},
      {"surface_ply",
       "ply\nformat ascii 1.0\nelement face " + kLie + "\nproperty list uchar int vertex_indices\nend_header\n"},
      {"stl", stl_head + "\xff\xff\xff\x7f" + std::string(50, '\0')},
      {"off", "OFF\n" + kLie + " 1 0\n0 0 0\n"},
      {"off", "OFF\n3 " + kLie + " 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"},
      {"nii", nifti},
      {"nii_gz", packed(nifti, true)},
      {"nrrd", "NRRD0004\ntype: uchar\ndimension: 3\n" + huge + "encoding: raw\n\nabc"},
      {"nrrd", "NRRD0004\ntype: uchar\ndimension: 3\n" + huge + "encoding: gzip\n\n" + packed("abc", true)},
      {"mha", "NDims = 3\nDimSize = 353535235358 7 5\nElementType = MET_UCHAR\nElementDataFile = LOCAL\nabc"}};
  for (const auto& [reader, content] : lies) {
    EXPECT_EQ(reader_named(reader).read(content), Verdict::refused) << reader << ": " << content.substr(0, 200);
    expect_bounded(reader, content);
  }
}

TEST(ReadingMemory, OfCenterlinesIsAMultipleOfTheFile) {
  expect_bounded("swc", numbered("% 1 % 0 0 1 -1\n"));
  expect_bounded("swc", many("#\n"));
  expect_bounded("swc", many("a "));
  expect_bounded("vmv", many("1\n", "$STRANDS_LIST_BEGIN\n", "$STRANDS_LIST_END\n"));
  expect_bounded("vmv", many("1 ", "$STRANDS_LIST_BEGIN\n", "\n$STRANDS_LIST_END\n"));
  expect_bounded("vmv", numbered("$%_BEGIN\n$%_END\n"));
  expect_bounded("vmv", numbered("% % 0 0 1\n", "$VERT_LIST_BEGIN\n", "$VERT_LIST_END\n"));
  expect_bounded("csv", many(","));
  expect_bounded("csv", numbered("%,%,0,0,1\n", "id,x,y,z,radius\n"));
  expect_bounded("csv", many("0,0\n", "id,x,y,z,radius\n0,0,0,0,1\n\fa,b\n"));
}

TEST(ReadingMemory, OfOtherProgramsFilesIsAMultipleOfTheFile) {
  const std::string curve = R"({"markups": [{"type": "Curve", "controlPoints": [)";
  expect_bounded("json", many("{},", curve, "{}]}]}"));
  expect_bounded("json", many("{\"type\": \"Line\"},", "{\"markups\": [", "{}]}"));
  expect_bounded("ctgr", many("<contour/>", "<contourgroup><timestep>", "</timestep></contourgroup>"));
  expect_bounded(
      "pth", many("<path_point><pos x=\"1\" y=\"1\" z=\"1\"/></path_point>",
                  "<path><timestep><path_element><path_points>", "</path_points></path_element></timestep></path>"));
  const std::string position =
      "<attr name=\"position\"><tup><float>1</float><float>1</float><float>1</float></tup></attr>";
  expect_bounded("gxl", numbered("<node id=\"%\">" + position + "</node>", "<gxl><graph>", "</graph></gxl>"));
  expect_bounded("gxl", many("<edge from=\"a\" to=\"b\"><attr name=\"radius\"><float>1</float></attr></edge>",
                             "<gxl><graph><node id=\"a\">" + position + "</node><node id=\"b\">" + position + "</node>",
                             "</graph></gxl>"));
  const std::string edge = "<edge source='1' target='2'/>", place = "<data key='pos'>0 0 0</data>";
  expect_bounded("graphml",
                 numbered("<node id='%'>" + place + "</node>", "<graphml><graph>", edge + "</graph></graphml>"));
  expect_bounded("graphml", numbered("<data key='area%'>1</data>", "<graphml><graph><node id='1'>" + place,
                                     "</node><node id='2'>" + place + "</node>" + edge + "</graph></graphml>"));
  expect_bounded("graphml", many(edge, "<graphml><graph><node id='1'>" + place + "</node>", "</graph></graphml>"));
  expect_bounded("gexf", numbered("<node id='%'><viz:position x='0' y='0' z='0'/></node>", "<gexf><graph><nodes>",
                                  "</nodes><edges>" + edge + "</edges></graph></gexf>"));
  expect_bounded("json", numbered(R"({"id":%,"pos":[0,0,0]},)", R"({"nodes":[)",
                                  R"({"id":-1,"pos":[0,0,0]}],"links":[{"source":1,"target":2}]})"));
  expect_bounded("tre", many("ObjectType=Tube\n", "ObjectType=Scene\n"));
  expect_bounded("tre", numbered("ObjectType=Group\nID=%\nParentID=%\n"));
  expect_bounded("tre", many("0 0 0 1\n", "ObjectType=Tube\nPointDim=x y z r\nNPoints=131000\nPoints=\n"));
  const std::string network = "t\n1 1 1\n1 1 1\n1\n1\n1\n";
  expect_bounded("dat", many("1 5 1 2 9\n", network + "99999\nhead\n"));
  expect_bounded("dat", numbered("% 1 1 1\n", network + "0\nhead\n999999\nhead\n"));
  expect_bounded("am", many("0 ", amira_head("300000") + "@1\n"));
  expect_bounded("am", numbered("VERTEX { byte a } @%\n", "# AmiraMesh ASCII\n"));
  expect_bounded("am", numbered("define a% 1\n", "# AmiraMesh ASCII\n"));
}

TEST(ReadingMemory, OfJsonIsAMultipleOfTheFile) {
  expect_bounded("json", many("["));
  expect_bounded("json", std::string(kSize / 2, '[') + std::string(kSize / 2, ']'));
  expect_bounded("json", many("[],", "[", "[]]"));
  expect_bounded("json", many("{},", "[", "{}]"));
  expect_bounded("json", many("{\"\":"));
  expect_bounded("json", many("\"\",", "[", "\"\"]"));
  expect_bounded("json", numbered("\"%\":1,", "{", "\"\":1}"));
  const std::string head = R"({"schema": "vmesh.centerline/1", "nodes": [)";
  expect_bounded("json", numbered("[%,0,0,1],", head, "[0,0,0,1]], \"segments\": []}"));
  expect_bounded("json", many("[0,1],", head + "[0,0,0,1],[5,0,0,1]], \"segments\": [", "[0,1]]}"));
}

TEST(ReadingMemory, OfLegacyVtkIsAMultipleOfTheFile) {
  const std::string head = "# vtk DataFile Version 3.0\nt\nASCII\nDATASET POLYDATA\nPOINTS ";
  const auto points = [&](std::size_t count) { return head + std::to_string(count) + " float\n"; };
  expect_bounded("vtk", many("0 ", points(kSize / 6 - 100)));
  expect_bounded("vtk", many("0 ", points(1) + "0 0 0\nLINES 400000 400000\n"));
  expect_bounded("vtk", many("1 0 ", points(1) + "0 0 0\nVERTICES 250000 500000\n"));
  expect_bounded("vtk", numbered("a% 0 0 f ", points(1) + "0 0 0\nPOINT_DATA 1\nFIELD f 100000\n"));
}

TEST(ReadingMemory, OfVtpIsAMultipleOfTheFile) {
  const auto piece = [](const std::string& counts) {
    return "<VTKFile type=\"PolyData\"><PolyData><Piece " + counts + ">";
  };
  const std::string array = "<DataArray type=\"Int8\" NumberOfComponents=\"3\">", end = "</Piece></PolyData></VTKFile>";
  for (const char* reader : {"vtp", "surface_vtp"}) {
    expect_bounded(reader, many("<a>"));
    expect_bounded(reader, many("<a/>", "<VTKFile>", "</VTKFile>"));
    expect_bounded(reader, many(" a=''", "<VTKFile", "/>"));
    const std::size_t count = kSize / 6 - 100;
    expect_bounded(reader, many("0 ", piece("NumberOfPoints=\"" + std::to_string(count) + "\"") + "<Points>" + array,
                                "</DataArray></Points>" + end));
    // Arrays that share their data.
    const std::string data = std::string("_\0\0\1\0", 5) + std::string(1 << 16, '\0');
    expect_bounded(reader,
                   numbered("<DataArray type=\"Int8\" Name=\"%\" format=\"appended\" offset=\"0\"/>",
                            piece("NumberOfPoints=\"21845\"") +
                                "<Points><DataArray type=\"Int8\" "
                                "NumberOfComponents=\"3\" format=\"appended\" offset=\"0\"/></Points><PointData>",
                            "</PointData></Piece></PolyData><AppendedData encoding=\"raw\">" + data +
                                "</AppendedData></VTKFile>"));
  }
  const std::string one = "<Points>" + array +
                          "0 0 0</DataArray></Points><PointData><DataArray type=\"Int8\" "
                          "Name=\"radius\">1</DataArray></PointData><Verts><DataArray type=\"Int8\" Name=\"";
  const std::string counts = "NumberOfPoints=\"1\" NumberOfVerts=\"500000\"";
  expect_bounded(
      "vtp", many("0 ", piece(counts) + one + "connectivity\">0</DataArray><DataArray type=\"Int8\" Name=\"offsets\">",
                  "</DataArray></Verts>" + end));
}

TEST(ReadingMemory, OfSurfacesIsAMultipleOfTheFile) {
  const std::string vertices = "element vertex 3\nproperty uchar x\nproperty uchar y\nproperty uchar z\n";
  const std::string ply = "ply\nformat binary_little_endian 1.0\n";
  const std::string points(9, '\1');
  const std::string list = "property list uchar uchar vertex_index\n";
  expect_bounded(
      "surface_ply",
      many("\1\2\3",
           ply + "element vertex 300000\nproperty uchar x\nproperty uchar y\nproperty uchar z\nend_header\n"));
  expect_bounded("surface_ply", many(std::string(1, '\0'),
                                     ply + vertices + "element face 1000000\n" + list + "end_header\n" + points));
  std::string fan = std::string(1, '\xff');
  for (int i = 0; i < 255; ++i) fan += static_cast<char>(i % 3);
  expect_bounded("surface_ply", many(fan, ply + vertices + "element face 4000\n" + list + "end_header\n" + points));
  expect_bounded("surface_ply", many("property uchar a\n", ply + vertices, "end_header\n"));
  expect_bounded("surface_ply", numbered("element % 0\n", ply, "end_header\n"));
  expect_bounded("stl", many("vertex 0 0 0\n", "solid\n"));
  expect_bounded("stl", numbered("vertex % 0 0\n", "solid\nvertex 0 1 2\nvertex 0 1 1\n", "endloop\n"));
  expect_bounded("surface_obj", many("f\n"));
  expect_bounded("surface_obj", many("f 1 2 3\n", "v 0 0 0\nv 1 0 0\nv 0 1 0\n"));
  expect_bounded("surface_obj", many("1 2 ", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 3 "));
  expect_bounded("surface_obj", many("v 0 0 0\n"));
  expect_bounded("off", many("0 0 0\n", "OFF\n170000 1\n"));
  expect_bounded("off", many("1 2 ", "OFF\n3 1\n0 0 0\n1 0 0\n0 1 0\n500000 0 "));
}

TEST(ReadingMemory, OfImagesIsAMultipleOfWhatTheyHold) {
  SampleImage image;
  image.size = {128, 128, 64};
  const std::string voxels(kSize, '\7');
  const std::string nifti = nifti_file<std::uint8_t>(image, {}) + voxels;
  expect_bounded("nii", nifti);
  expect_bounded("nrrd", nrrd_header(image, "uchar") + voxels);
  expect_bounded("mha", mha_header(image, "MET_UCHAR") + voxels);
  const bool reads_tiff = std::ranges::any_of(readers(), [](const Reader& reader) { return reader.name == "tif"; });
  if (reads_tiff) expect_bounded("tif", tiff_file<std::uint8_t>(image, std::vector<double>(kSize, 7)));
  const std::pair<const char*, std::string> packed_files[] = {
      {"nii_gz", packed(nifti, true)},
      {"nrrd", nrrd_header(image, "uchar", "encoding: gzip\n") + packed(voxels, true)},
      {"mha", mha_header(image, "MET_UCHAR", "CompressedData = True\n") + packed(voxels, false)}};
  for (const auto& [reader, content] : packed_files) {
    EXPECT_EQ(reader_named(reader).read(content), Verdict::read);
    EXPECT_LT(content.size(), kSize / 100);
    EXPECT_LE(peak_while_reading(reader_named(reader), content), kMostPerUnpackedByte * kSize + kRoom) << reader;
  }
}

TEST(ReadingMemory, OfImagesSliceBySliceIsThatOfTwoSlices) {
  SampleImage image;
  image.size = {128, 128, 4096};
  const std::string voxels(std::size_t{1} << 26, '\7');
  const std::size_t slice = sizeof(float) * 128 * 128, room = 2 << 20;
  const std::pair<const char*, std::string> files[] = {
      {"a.nii", nifti_file<std::uint8_t>(image, {}) + voxels},
      {"a.nii.gz", packed(nifti_file<std::uint8_t>(image, {}) + voxels, true)},
      {"a.nrrd", nrrd_header(image, "uchar", "encoding: gzip\n") + packed(voxels, true)},
      {"a.mha", mha_header(image, "MET_UCHAR", "CompressedData = True\n") + packed(voxels, false)}};
  for (const auto& [name, content] : files) {
    std::size_t slices = 0;
    const std::size_t before = live;
    peak = before;
    parse_image_slices(
        content, name, [](const ImageFrame&) {}, [&](std::size_t, std::span<const float>) { ++slices; });
    EXPECT_EQ(slices, 4096u) << name;
    EXPECT_LE(peak - before, 2 * slice + room) << name;
  }
}

}  // namespace
}  // namespace vmesh::testing
