#include "seeds.h"

namespace vmesh::testing {
namespace {

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

}  // namespace

std::vector<std::string> swc_seeds() {
  return {"# SPACE=RAS UNIT=um\n1 1 0 0 0 2 -1\n2 3 8 0 0 1.5 1\n3 3 12 4 0 1 2\n4 3 12.5 -4e0 0.1 0 2\n",
          "\xEF\xBB\xBF# two trees, odd roots\r\n0 0 1 2 3 4 -2\r\n7\t5\t+1\t-.5\t1e-400\t2.5\t0 extra\r\n\r\n"
          "9 1 100 100 100 1 -1 # alone"};
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
 "nodes": [[1e3, -0.5, 1e-9, 2]], "segments": []})"};
}

std::vector<std::string> csv_seeds() {
  return {"# SPACE=LPS\nid,x,y,z,radius\n0,0,0,0,2\n1,8,0,0,1.5\n2,12,4,0,1\n\fa,b\n0,1\n1,2\n",
          "note, Radius ,z,y,x,id\nhello,1,2,3,4,10\r\n,1,2,3,14,11\r\n\fb,a,why\n10,11,\n"};
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
      "FIELD f 2\nradius 1 3 double\n1 1 1\nother 2 1 int\n1 2\n"};
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

}  // namespace vmesh::testing
