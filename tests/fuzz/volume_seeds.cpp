#include "seeds.h"

namespace vmesh::testing {
namespace {

std::string array(const std::string& type, const std::string& name, const std::string& values,
                  const std::string& more = {}) {
  return "<DataArray type=\"" + type + "\" Name=\"" + name + "\"" + more + " format=\"ascii\">" + values +
         "</DataArray>";
}

std::string grid(const std::string& field, const std::string& points, const std::string& point_data,
                 const std::string& cells, const std::string& cell_data, int point_count, int cell_count) {
  return "<VTKFile type=\"UnstructuredGrid\"><UnstructuredGrid><FieldData>" + field +
         "</FieldData><Piece NumberOfPoints=\"" + std::to_string(point_count) + "\" NumberOfCells=\"" +
         std::to_string(cell_count) + "\"><PointData>" + point_data + "</PointData><CellData>" + cell_data +
         "</CellData><Points>" + array("Float32", "Points", points, " NumberOfComponents=\"3\"") + "</Points><Cells>" +
         cells + "</Cells></Piece></UnstructuredGrid></VTKFile>";
}

std::string texts(const std::string& name, const std::string& codes) {
  return "<Array type=\"String\" Name=\"" + name + "\" format=\"ascii\">" + codes + "</Array>";
}

std::vector<std::string> grids() {
  // A tetrahedron with its faces, in two patches with names.
  const std::string named =
      grid(texts("PatchNames", "97 0 98 0") + texts("RegionNames", "99 0") + texts("UNIT", "109 109 0"),
           "0 0 0 1 0 0 0 1 0 0 0 1", array("Float64", "radius", "1 2 3 4"),
           array("Int32", "connectivity", "0 1 2 3 0 2 1 0 1 3 1 2 3 2 0 3") +
               array("Int32", "offsets", "4 7 10 13 16") + array("UInt8", "types", "10 5 5 5 5"),
           array("Int32", "ModelRegionID", "1 1 1 1 1") + array("Int32", "ModelFaceID", "0 1 2 2 2"), 4, 5);
  // A wedge, a pyramid on it, a tetrahedron on that and a line, without faces.
  const std::string mixed = grid("", "0 0 0 1 0 0 0 1 0 0 0 1 1 0 1 0 1 1 .75 .75 .5 1.25 .5 .5", "",
                                 array("Int64", "connectivity", "0 2 1 3 5 4 1 2 5 4 6 1 6 4 7 0 1") +
                                     array("Int64", "offsets", "6 11 15 17") + array("UInt8", "types", "13 14 10 3"),
                                 array("Float32", "layer", "1 2 3 4"), 8, 4);
  return {named, mixed};
}

}  // namespace

std::map<std::string, MakeSeeds> volume_seeds() { return {{".vtu", grids}}; }

}  // namespace vmesh::testing
