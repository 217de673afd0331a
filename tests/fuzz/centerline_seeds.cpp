#include <algorithm>
#include <bit>
#include <cstdint>
#include <initializer_list>

#include "seeds.h"

namespace vmesh::testing {
namespace {

/// The numbers as bytes, the most significant first or last.
template <class Number>
std::string bytes_of(std::initializer_list<Number> numbers, std::endian order) {
  std::string all;
  for (const Number number : numbers) {
    std::string one(reinterpret_cast<const char*>(&number), sizeof number);
    if (order != std::endian::native) std::reverse(one.begin(), one.end());
    all += one;
  }
  return all;
}

/// Three times the number 1 in big-endian single precision, packed by zlib.
constexpr char kPackedOnes[] = "\170\332\263\157\140\140\260\207\142\000\020\164\002\076";

template <class Number>
std::string big(std::initializer_list<Number> numbers) {
  return bytes_of(numbers, std::endian::big);
}

/// A VTP file of two polylines and five points; `arrays` stands for the three pieces of data that follow the points.
std::string vtp_text(const std::string& radius, const std::string& points, const std::string& lines,
                     const std::string& attributes = "") {
  return "<?xml version=\"1.0\"?>\n<VTKFile type=\"PolyData\" version=\"0.1\" byte_order=\"LittleEndian\" " +
         attributes +
         ">\n<PolyData>\n<FieldData><DataArray type=\"String\" Name=\"SPACE\" NumberOfTuples=\"1\" format=\"ascii\">"
         "76 80 83 0</DataArray></FieldData>\n"
         "<Piece NumberOfPoints=\"5\" NumberOfVerts=\"0\" NumberOfLines=\"2\" NumberOfStrips=\"0\" "
         "NumberOfPolys=\"0\">\n<PointData>" +
         radius + "</PointData>\n<Points>" + points + "</Points>\n<Lines>" + lines +
         "</Lines>\n</Piece>\n</PolyData>\n</VTKFile>\n";
}

std::string array(const std::string& attributes, const std::string& data) {
  return "<DataArray " + attributes + ">" + data + "</DataArray>";
}

std::vector<std::string> swc_seeds() {
  return {"# SPACE=RAS UNIT=um\n1 1 0 0 0 2 -1\n2 3 8 0 0 1.5 1\n3 3 12 4 0 1 2\n4 3 12.5 -4e0 0.1 0 2\n",
          "\xEF\xBB\xBF# two trees, odd roots\r\n0 0 1 2 3 4 -2\r\n7\t5\t+1\t-.5\t1e-400\t2.5\t0 extra\r\n\r\n"
          "9 1 100 100 100 1 -1 # alone",
          "720575940590515268 0 0 0 0 3 0\n-7 0 1 0 0 3 720575940590515268\ntip 0 4 0 0 3 -07\n"};
}

std::vector<std::string> vmv_seeds() {
  return {
      "$PARAM_BEGIN\n$NUM_VERTS 4\n$NUM_STRANDS 2\n$NUM_ATTRIB_PER_VERT 4\n$PARAM_END\n"
      "$VERT_LIST_BEGIN\n1 0 0 0 1\n2 5 0 0 1\n3 9 3 0 .7\n4 9 -3 0 .7\n$VERT_LIST_END\n"
      "$STRANDS_LIST_BEGIN\n1 1 2 3\n2 2 4\n$STRANDS_LIST_END\n",
      "# UNIT=um\n$strands_list_begin\n9 0 1\n$strands_list_end\n$other_begin\n1 2\n$other_end\n"
      "$vert_list_begin\n0 0 0 0 1\n1 1e1 0 0 1 7\n$vert_list_end\n"};
}

std::vector<std::string> json_seeds() {
  return {R"({"schema": "vmesh.centerline/1", "space": "LPS", "unit": "mm",
 "nodes": [[0, 0, 0, 2], [8, 0, 0, 1.5], [12, 4, 0, 1], [12, -4, 0, 1]],
 "segments": [[0, 1], [1, 2], [1, 3]]})",
          R"({"schema": "vmesh.centerline/1", "unit": "um", "options": "\u00e4\n", "more": {"a": [true, null, {}]},
 "nodes": [[1e3, -0.5, 1e-9, 2]], "segments": []})",
          R"({"graph": {"unit": "um"}, "nodes": [{"id": 1, "pos": [0, 0, 0], "r": 2}, {"id": "b", "x": 0, "y": "9",
 "z": 0, "r": 1}], "links": [{"source": 1, "target": "b", "w": [1]}]})",
          R"({"schema": "vmesh.centerline/1", "nodes": [[0, 0, 0, 2], [8, 0, 0, 2]], "segments": [[0, 1]],
 "end_sections": [{"node": 1, "center": [8, 0, 0], "normal": [1, 0, 0.1], "area": 12.5, "open": false},
 {"node": 0, "center": [0, 0, 0], "normal": [-1, 0, 0], "area": 8, "open": true,
 "ring": [[0, 2, 0], [0, -1, -2], [0, -1, 2]]}]})"};
}

std::vector<std::string> markups_seeds() {
  return {R"({"markups": [{"type": "Fiducial"}, {"type": "Curve", "coordinateSystem": "RAS", "coordinateUnits": "cm",
 "controlPoints": [{"position": [0, 0, 0]}, {"position": [0, 0, 9], "positionStatus": "defined"},
 {"positionStatus": "undefined", "position": []}],
 "measurements": [{"name": "length"}, {"name": "Radius", "units": "mm", "controlPointValues": [2, 1.5, 0]}]},
 {"type": "Line", "coordinateSystem": "RAS", "coordinateUnits": ["cm"], "measurements": [{"name": "radius",
 "controlPointValues": [1, 1]}], "controlPoints": [{"position": [0, 0, 5]}, {"position": [5, 0, 5]}]}]})"};
}

std::vector<std::string> csv_seeds() {
  return {"# SPACE=LPS\nid,x,y,z,radius\n0,0,0,0,2\n1,8,0,0,1.5\n2,12,4,0,1\n\fa,b\n0,1\n1,2\n",
          "note, Radius ,z,y,x,id\nhello,1,2,3,4,10\r\n,1,2,3,14,11\r\n\fb,a,why\n10,11,\n",
          "id;pos_x;pos_y;pos_z\n0;0;0;0\n1;0;0;20\n\fid;node1id;node2id;avgRadiusAvg\n0;0;1;2.5\n",
          "id,x,y,z,Section Area\n0,0,0,0,2\n1,8,0,0,1.5\n\fa,b\n0,1\n",
          "id;x;y;z;\"radius\"\r\nroot;0,5;1;2;1,5\r\n720575940590515268;1;2;3;1\r\n;;;;\r\n\f"
          "a;b\r\nroot;720575940590515268\r\n"};
}

std::vector<std::string> vtk_seeds() {
  return {
      "# vtk DataFile Version 3.0\nSPACE=RAS\nASCII\nDATASET POLYDATA\nPOINTS 4 float\n0 0 0 8 0 0 12 4 0 12 -4 0\n"
      "LINES 2 7\n3 0 1 2\n2 1 3\nPOINT_DATA 4\nSCALARS Radius double 1\nLOOKUP_TABLE default\n2 1.5 1 1\n"
      "VECTORS v float\n0 0 0 0 0 0 0 0 0 0 0 0\n",
      "# vtk DataFile Version 5.1\ntitle\nASCII\nDATASET POLYDATA\nFIELD FieldData 1\nUNIT 1 1 string\num\n"
      "POINTS 3 double\n0 0 0 1 0 0 2 0 0\nMETADATA\nINFORMATION 0\n\nVERTICES 2 1\nOFFSETS vtktypeint64\n0 1\n"
      "CONNECTIVITY vtktypeint64\n2\nLINES 2 2\nOFFSETS vtktypeint64\n0 2\nCONNECTIVITY vtktypeint64\n0 1\n"
      "POLYGONS 1 4\n3 0 1 2\nCELL_DATA 2\nSCALARS c int\nLOOKUP_TABLE default\n1 2\nPOINT_DATA 3\n"
      "COLOR_SCALARS k 1\n0 0 1\nTEXTURE_COORDINATES t 2 float\n0 0 1 1 0 0\nLOOKUP_TABLE l 1\n0 0 0 1\n"
      "FIELD f 2\nradius 1 3 double\n1 1 1\nother 2 1 int\n1 2\n",
      "# vtk DataFile Version 4.2\nSPACE=LPS\nBINARY\nDATASET POLYDATA\nPOINTS 3 float\n" +
          big<float>({0, 0, 0, 1, 0, 0, 2, 0, 0}) + "\nMETADATA\nINFORMATION 0\n\nLINES 1 4\n" +
          big<std::int32_t>({3, 0, 1, 2}) + "\nVERTICES 1 2\n" + big<std::int32_t>({1, 2}) +
          "\nCELL_DATA 2\nFIELD FieldData 2\nDiameter 1 2 unsigned_char\n\2\1\nname 1 2 string\n\xc2no\xc1x\n" +
          "POINT_DATA 3\nSCALARS flag bit\nLOOKUP_TABLE default\n\xa0\nCOLOR_SCALARS c 1\n\1\2\3\n"
          "VECTORS v short\n" +
          big<std::int16_t>({0, 0, 1, 0, 0, 1, 0, 0, 1}) + "\nSCALARS Radius double\n" + "LOOKUP_TABLE default\n" +
          big<double>({1, 1, 0.5}) + "\n",
      "# vtk DataFile Version 5.1\nt\nBINARY\nDATASET POLYDATA\nPOINTS 2 double\n" + big<double>({0, 0, 0, 0, 9, 0}) +
          "\nLINES 2 2\nOFFSETS vtktypeint64\n" + big<std::int64_t>({0, 2}) + "\nCONNECTIVITY vtktypeint64\n" +
          big<std::int64_t>({0, 1}) + "\nCELL_DATA 1\nSCALARS Radius float\nLOOKUP_TABLE default\n" + big<float>({1}) +
          "\n"};
}

std::vector<std::string> ctgr_seeds() {
  const std::string head = "<?xml version=\"1.0\"?>\n<format version=\"1.0\" />\n<contourgroup><timestep id=\"0\">";
  const auto contour = [](const std::string& z) {
    return "<contour><contour_points><point x=\"1\" y=\"1\" z=\"" + z + "\"/><point x=\"-1\" y=\"1\" z=\"" + z +
           "\"/><point x=\"-1\" y=\"-1\" z=\"" + z + "\"/><point x=\"1\" y=\"-1\" z=\"" + z +
           "\"/></contour_points></contour>";
  };
  return {head + contour("0") + contour("2.5") + "<contour/>" + contour("5e0") + "</timestep></contourgroup>",
          head + contour("-1") + contour("1") + "</timestep><timestep/></contourgroup>"};
}

std::vector<std::string> pth_seeds() {
  return {
      "<format version=\"1.0\" />\n<path id=\"1\"><timestep id=\"0\"><path_element><control_points/><path_points>"
      "<path_point id=\"0\"><pos x=\"0\" y=\"1\" z=\"2\"/></path_point>"
      "<path_point id=\"1\"><pos x=\"0.5\" y=\"1\" z=\"9\"/><tangent x=\"0\" y=\"0\" z=\"1\"/></path_point>"
      "</path_points></path_element></timestep></path>"};
}

std::vector<std::string> gxl_seeds() {
  const auto node = [](const std::string& id, const std::string& position) {
    return "<node id=\"" + id +
           "\"><attr name=\" nodeType\"><string> bifurication </string></attr>"
           "<attr name=\" position\"><tup>" +
           position + "</tup></attr></node>";
  };
  return {"<gxl><graph id=\"g\">" + node("n0", "<float>0</float><float> 5 </float><float>5</float>") +
          node("n1", "<float>30</float><float>5</float><float>5</float>") +
          node("n2", "<float>50</float><float>15</float><float>5</float>") +
          "<edge id=\"e0\" from=\"n0\" to=\"n1\"><attr name=\" flow\"><float>9</float></attr><attr name=\" radius\">"
          "<float>2.5</float></attr></edge><edge id=\"e1\" to=\"n2\" from=\"n1\"><attr name=\" radius\">"
          "<float>1</float></attr></edge></graph></gxl>"};
}

std::vector<std::string> graphml_seeds() {
  const auto node = [](const std::string& id, const std::string& data) {
    return "<node id=\"" + id + "\">" + data + "</node>";
  };
  const std::string keys =
      "<key id=\"d0\" for=\"node\" attr.name=\"pos\"/><key id=\"d1\" for=\"node\" attr.name=\"radius\"/>"
      "<key id=\"d2\" for=\"edge\" attr.name=\"diameter\"/>";
  return {"<graphml>" + keys + "<graph>" + node("a", "<data key=\"d0\">[0, 0.5, 2]</data><data key=\"d1\">2</data>") +
              node("b", "<data key=\"x\">9</data><data key=\"y\">0</data><data key=\"z\">0</data>") +
              "<edge source=\"a\" target=\"b\"/></graph></graphml>",
          "<graphml>" + keys + "<graph><data key=\"unit\">um</data>" + node("1", "<data key=\"d0\">0 0 0</data>") +
              node("2", "<data key=\"d0\">0 0 9</data>") +
              "<edge source=\"1\" target=\"2\"><data key=\"d2\">4</data></edge></graph></graphml>"};
}

std::vector<std::string> tre_seeds() {
  const std::string head = "ObjectType = Scene\nNDims = 3\nNObjects = 2\n";
  const auto tube = [](const std::string& more, const std::string& points) {
    return "ObjectType = Tube\nNDims = 3\n" + more + "PointDim = x y z r\nNPoints = 2\nPoints = \n" + points;
  };
  return {head + "ObjectType = Group\nID = 5\nOffset = 1 2 3\nEndGroup = \n" +
              tube("ID = 1\nParentID = 5\nElementSpacing = 0.5 0.5 2\n", "0 0 0 4\n0 0 9 3\n") +
              tube("ID = 2\nParentID = 1\nParentPoint = 1\n", "0 0 18 2\n0 8 18 1\n"),
          head + tube("BinaryData = True\nTransformMatrix = 0 1 0 1 0 0 0 0 1\n",
                      bytes_of<float>({0, 0, 0, 2, 0, 0, 9, 2}, std::endian::little))};
}

std::vector<std::string> gexf_seeds() {
  return {
      "<gexf><graph><attributes class=\"node\"><attribute id=\"0\" title=\"radius\"/></attributes><nodes>"
      "<node id=\"a\"><attvalues><attvalue for=\"0\" value=\"2\"/></attvalues><viz:position x=\"0\" y=\"0\" z=\"0\"/>"
      "</node><node id=\"b\"><attvalues><attvalue for=\"0\" value=\"1.5\"/></attvalues>"
      "<viz:position x=\"0\" y=\"8\" z=\"0\"/></node></nodes>"
      "<edges><edge id=\"0\" source=\"a\" target=\"b\"/></edges></graph></gexf>"};
}

std::vector<std::string> amira_seeds() {
  const auto little = [](auto numbers) { return bytes_of(numbers, std::endian::little); };
  using Ints = std::initializer_list<std::int32_t>;
  using Floats = std::initializer_list<float>;
  const std::string header =
      "\n\ndefine VERTEX 2\ndefine EDGE 1\ndefine POINT 3\n\nParameters {\n Units {\n  Coordinates \"um\"\n }\n "
      "ContentType \"HxSpatialGraph\"\n}\n\nVERTEX { float[3] VertexCoordinates } @1\nEDGE { int[2] EdgeConnectivity } "
      "@2\nEDGE { int NumEdgePoints } @3\nPOINT { float[3] EdgePointCoordinates } @4\n";
  return {
      "# AmiraMesh 3D ASCII 2.0" + header +
          "POINT { float thickness } @5\nVERTEX { byte label } = @6\n\n# Data section follows\n@1\n0 0 0\n9 0 0\n\n@2\n"
          "0 1\n\n@3\n3\n@4\n0 0 0\n5 1 0\n9 0 0\n@5\n1 1.5\n1\n@6\n1\n2\n",
      "# AmiraMesh BINARY-LITTLE-ENDIAN 2.1" + header +
          "EDGE { float Diameter } @5\nVERTEX { byte l } @6(HxByteRLE,2)\n@1\n" + little(Floats{0, 0, 0, 9, 0, 0}) +
          "\n@2\n" + little(Ints{0, 1}) + "\n@3\n" + little(Ints{3}) + "\n@4\n" +
          little(Floats{0, 0, 0, 5, 1, 0, 9, 0, 0}) + "\n@5\n" + little(Floats{3}) + "\n@6\n\2\7\n",
      // The radius packed: 1, 1, 1.
      "# Avizo BINARY 2.0" + header + "POINT { float Radius } @5(HxZip,14)\n@1\n" + big<float>({0, 0, 0, 9, 0, 0}) +
          "\n@2\n" + big<std::int32_t>({0, 1}) + "\n@3\n" + big<std::int32_t>({3}) + "\n@4\n" +
          big<float>({0, 0, 0, 5, 1, 0, 9, 0, 0}) + "\n@5\n" + std::string(kPackedOnes, sizeof kPackedOnes - 1) + "\n"};
}

std::vector<std::string> network_seeds() {
  return {
      "Network\n550. 550. 230. box dimensions in microns\n32 32 14 number of tissue points\n20. outer bound\n"
      "40. max. segment length\n50 maximum segments per node\n3 total number of segments\n"
      "name type from to diam flow hd\n1 5 1 2 12.5 3 .4\n2 5 2 3 8 1.5 .4\n3 5 2 4 8 1.5 .4\n"
      "4 total number of nodes\nname x y z\n1 0 0 0\n2 100 0 0\n3 150 60 0\n4 150 -60 0\n"
      "1 total number of boundary nodes\nnode bctype press\n1 0 30 .4\n"};
}

std::vector<std::string> vtp_seeds() {
  const std::string ids = "0 1 2 2 4", offsets = "3 5";
  return {
      vtp_text(array("type=\"Float64\" Name=\"Radius\" format=\"ascii\"", "1 2 3 4 5"),
               array("type=\"Float32\" NumberOfComponents=\"3\" format=\"ascii\"", "0 0 0 1 0 0 2 0 0 5 5 5 2 1 0"),
               array("type=\"Int64\" Name=\"connectivity\" format=\"ascii\"", ids) +
                   array("type=\"Int64\" Name=\"offsets\" format=\"ascii\"", offsets)),
      // Binary: the number of bytes in four bytes, then the bytes.
      vtp_text(array("type=\"UInt8\" Name=\"radius\" format=\"binary\"", "BQAAAAECAwQF"),
               array("type=\"Int8\" NumberOfComponents=\"3\" format=\"binary\"", "DwAAAAAAAAEAAAIAAAUFBQIBAA=="),
               array("type=\"UInt8\" Name=\"connectivity\" format=\"binary\"", "BQAAAAABAgIE") +
                   array("type=\"UInt16\" Name=\"offsets\" format=\"binary\"", "BAAAAAMABQA="),
               "header_type=\"UInt32\""),
      // Packed: one block of 5 or 15 bytes.
      vtp_text(
          array("type=\"UInt8\" Name=\"Radius\" format=\"binary\"", "AQAAAAUAAAAFAAAADQAAAA==eJxjZGJmYQUAACgAEA=="),
          array("type=\"Int8\" NumberOfComponents=\"3\" format=\"ascii\"", "0 0 0 1 0 0 2 0 0 5 5 5 2 1 0"),
          array("type=\"Int32\" Name=\"connectivity\" format=\"ascii\"", ids) +
              array("type=\"Int32\" Name=\"offsets\" format=\"ascii\"", offsets),
          "header_type=\"UInt32\" compressor=\"vtkZLibDataCompressor\""),
      // A flat end with a ring.
      "<VTKFile type=\"PolyData\"><PolyData><FieldData>" + array("type=\"Int32\" Name=\"EndSectionNode\"", "1") +
          array("type=\"Int8\" Name=\"EndSectionCenter\"", "3 0 0") +
          array("type=\"Int8\" Name=\"EndSectionNormal\"", "1 0 0") +
          array("type=\"Int8\" Name=\"EndSectionArea\"", "4") + array("type=\"Int8\" Name=\"EndSectionOpen\"", "1") +
          array("type=\"Int8\" Name=\"EndSectionRing\"", "3 1 0 3 -1 1 3 -1 -1") +
          array("type=\"Int8\" Name=\"EndSectionRingOffsets\"", "0 3") +
          "</FieldData><Piece NumberOfPoints=\"2\" NumberOfLines=\"1\"><PointData>" +
          array("type=\"Int8\" Name=\"Radius\"", "1 1") + "</PointData><Points>" +
          array("type=\"Int8\" NumberOfComponents=\"3\"", "0 0 0 3 0 0") + "</Points><Lines>" +
          array("type=\"Int8\" Name=\"connectivity\"", "0 1") + array("type=\"Int8\" Name=\"offsets\"", "2") +
          "</Lines></Piece></PolyData></VTKFile>",
      // The data of the points behind everything else.
      "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"BigEndian\" header_type=\"UInt64\"><PolyData>"
      "<Piece NumberOfPoints=\"1\" NumberOfVerts=\"1\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\"0\">"
      "<PointData><DataArray type=\"UInt8\" Name=\"Radius\" format=\"appended\" offset=\"0\"/></PointData>"
      "<Points><DataArray type=\"UInt16\" NumberOfComponents=\"3\" format=\"appended\" offset=\"9\"/></Points>"
      "<Verts><DataArray type=\"Int32\" Name=\"connectivity\" format=\"ascii\">0</DataArray>"
      "<DataArray type=\"Int32\" Name=\"offsets\" format=\"ascii\">1</DataArray></Verts>"
      "</Piece></PolyData><AppendedData encoding=\"raw\">_" +
          std::string("\0\0\0\0\0\0\0\1\7\0\0\0\0\0\0\0\6\0\1\0\2\0\3", 23) + "</AppendedData></VTKFile>"};
}

std::vector<std::string> vtu_seeds() {
  return {
      "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><Piece NumberOfPoints=\"4\" NumberOfCells=\"3\">"
      "<PointData>" +
      array("type=\"Int8\" Name=\"radius\"", "1 1 2 2") + "</PointData><CellData>" +
      array("type=\"Int8\" Name=\"mark\"", "7 8 9") + "</CellData><Points>" +
      array("type=\"Int8\" NumberOfComponents=\"3\"", "0 0 0 3 0 0 6 0 0 9 1 0") + "</Points><Cells>" +
      array("type=\"Int8\" Name=\"connectivity\"", "0 1 2 1 3 0 1 2") +
      array("type=\"Int8\" Name=\"offsets\"", "3 5 8") + array("type=\"UInt8\" Name=\"types\"", "4 3 5") +
      "</Cells></Piece></UnstructuredGrid></VTKFile>"};
}

std::vector<std::string> obj_line_seeds() { return {"v 0 0 0\nv 9 0 0\nv 9 9 0\nl 1 2 3\nv 9 -9 0\nl 2 -1\n"}; }

std::vector<std::string> ply_edge_seeds() {
  return {
      "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
      "property float radius\nelement edge 2\nproperty int vertex1\nproperty int vertex2\nend_header\n"
      "0 0 0 3\n5 0 0 2\n9 0 0 1\n0 1\n1 2\n"};
}

}  // namespace

std::map<std::string, MakeSeeds> centerline_seeds() {
  return {
      {".obj", obj_line_seeds},    {".ply", ply_edge_seeds},     {".vtu", vtu_seeds}, {".swc", swc_seeds},
      {".vmv", vmv_seeds},         {".json", json_seeds},        {".csv", csv_seeds}, {".vtk", vtk_seeds},
      {".vtp", vtp_seeds},         {".ctgr", ctgr_seeds},        {".pth", pth_seeds}, {".gxl", gxl_seeds},
      {".graphml", graphml_seeds}, {".gexf", gexf_seeds},        {".tre", tre_seeds}, {".am", amira_seeds},
      {".dat", network_seeds},     {".mrk.json", markups_seeds},
  };
}

}  // namespace vmesh::testing
