#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <mutex>
#include <ostream>
#include <thread>

#include <vtkCellArray.h>
#include <vtkCellData.h>
#include <vtkDoubleArray.h>
#include <vtkFieldData.h>
#include <vtkFloatArray.h>
#include <vtkIntArray.h>
#include <vtkLogger.h>
#include <vtkNew.h>
#include <vtkOutputWindow.h>
#include <vtkPointData.h>
#include <vtkPoints.h>
#include <vtkPolyData.h>
#include <vtkStringArray.h>
#include <vtkXMLPolyDataReader.h>
#include <vtkXMLPolyDataWriter.h>

#include "formats.h"
#include "poly_lines.h"
#include "text.h"
#include "triangulation.h"

namespace vmesh::io {
namespace {

/// Collects what VTK's objects say about errors and warnings.
class MessageWindow : public vtkOutputWindow {
 public:
  static MessageWindow* New() { return new MessageWindow; }
  void DisplayText(const char* message) override {
    if (std::this_thread::get_id() == owner_) text.append(message ? message : "").append(" ");
  }
  void DisplayDebugText(const char*) override {}

  std::string text;

 private:
  std::thread::id owner_ = std::this_thread::get_id();
};

/// While it lives, VTK's messages go to text() instead of the terminal. VTK's output window and log level belong to the
/// process, so one at a time; both are put back at the end.
class VtkMessages {
 public:
  VtkMessages()
      : lock_(mutex()), before_(vtkOutputWindow::GetInstance()), level_(vtkLogger::GetCurrentVerbosityCutoff()) {
    vtkOutputWindow::SetInstance(window_);
    vtkLogger::SetStderrVerbosity(vtkLogger::VERBOSITY_OFF);
  }
  ~VtkMessages() {
    vtkLogger::SetStderrVerbosity(level_);
    vtkOutputWindow::SetInstance(before_);
  }
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;

  const std::string& text() const { return window_->text; }

 private:
  static std::mutex& mutex() {
    static std::mutex instance;
    return instance;
  }

  std::lock_guard<std::mutex> lock_;
  vtkSmartPointer<vtkOutputWindow> before_;
  vtkLogger::Verbosity level_;
  vtkNew<MessageWindow> window_;
};

/// The first of VTK's messages without file, line and address of the object.
std::string first_message(std::string_view text) {
  const std::size_t address = text.find("): ");
  if (address != std::string_view::npos) text.remove_prefix(address + 3);
  return one_line(trim(text.substr(0, text.find('\n'))));
}

/// VTK allocates what the header promises before it reads: promises that no file of this size can keep are refused.
void check_promises(std::string_view content, const std::string& source) {
  constexpr std::uint64_t kMostPerByte = 1032;  // zlib's best ratio; at least a byte per element before that
  for (const std::string_view key : {"NumberOfPoints=", "NumberOfVerts=", "NumberOfLines=", "NumberOfStrips=",
                                     "NumberOfPolys=", "NumberOfComponents=", "NumberOfTuples="}) {
    for (std::size_t at = content.find(key); at != std::string_view::npos; at = content.find(key, at + 1)) {
      const std::string_view value = content.substr(std::min(at + key.size() + 1, content.size()), 24);
      const std::uint64_t most = key == "NumberOfComponents=" ? 4096 : content.size() * kMostPerByte;
      std::uint64_t count = 0;
      const auto result = std::from_chars(value.data(), value.data() + value.size(), count);
      if (result.ec == std::errc() && count <= most) continue;
      throw InvalidInput(source + ": " + std::string(key) + cite(value.substr(0, value.find('"'))) +
                         " is no count that a file of this size can hold; it is broken");
    }
  }
}

vtkSmartPointer<vtkPolyData> read_poly_data(std::string_view content, const std::string& source) {
  if (content.find("<VTKFile") == std::string_view::npos) {
    throw InvalidInput(source + ": this is no VTP file: there is no <VTKFile> element in it");
  }
  check_promises(content, source);
  const VtkMessages messages;
  vtkNew<vtkXMLPolyDataReader> reader;
  reader->ReadFromInputStringOn();
  reader->SetInputString(std::string(content));
  try {
    reader->Update();
  } catch (const std::bad_alloc&) {
    throw InvalidInput(source + ": the file asks for more memory than there is; it is broken");
  }
  if (!messages.text().empty()) throw InvalidInput(source + ": VTK cannot read it: " + first_message(messages.text()));
  vtkSmartPointer<vtkPolyData> data = reader->GetOutput();
  if (!data || !data->GetPoints() || data->GetNumberOfPoints() == 0) {
    throw InvalidInput(source + ": there is no point in it");
  }
  if (data->GetNumberOfPoints() >= static_cast<vtkIdType>(kNone)) throw InvalidInput(source + ": too many points");
  return data;
}

/// The cells of one kind as lists of point ids. VTK does not check what the file says about them.
class Cells {
 public:
  Cells(vtkCellArray* cells, vtkIdType point_count, const std::string& source, const char* kind) {
    if (!cells || cells->GetNumberOfCells() == 0) return;
    vtkDataArray* offsets = cells->GetOffsetsArray();
    vtkDataArray* ids = cells->GetConnectivityArray();
    const vtkIdType count = offsets->GetNumberOfTuples() - 1;
    for (vtkIdType c = 0; c <= count; ++c) {
      const double offset = offsets->GetComponent(c, 0);
      const double before = offsets_.empty() ? 0.0 : static_cast<double>(offsets_.back());
      if (!(offset >= before) || offset > static_cast<double>(ids->GetNumberOfTuples())) {
        throw InvalidInput(source + ": " + kind + " " + std::to_string(c) + ": its offset is out of range");
      }
      offsets_.push_back(static_cast<std::size_t>(offset));
    }
    for (vtkIdType i = 0; i < ids->GetNumberOfTuples(); ++i) {
      const double id = ids->GetComponent(i, 0);
      if (!(id >= 0 && id < static_cast<double>(point_count))) {
        throw InvalidInput(source + ": " + kind + "s: there is no point " + std::to_string(static_cast<long long>(id)) +
                           "; the points are 0 to " + std::to_string(point_count - 1));
      }
      ids_.push_back(static_cast<Index>(id));
    }
  }

  std::size_t size() const { return offsets_.empty() ? 0 : offsets_.size() - 1; }
  std::span<const Index> operator[](std::size_t c) const {
    return {ids_.data() + offsets_[c], ids_.data() + offsets_[c + 1]};
  }
  std::vector<std::vector<Index>> lists() const {
    std::vector<std::vector<Index>> result(size());
    for (std::size_t c = 0; c < size(); ++c) result[c].assign((*this)[c].begin(), (*this)[c].end());
    return result;
  }

 private:
  std::vector<std::size_t> offsets_;
  std::vector<Index> ids_;
};

std::string field_text(vtkPolyData& data, const char* name) {
  auto* array = vtkStringArray::SafeDownCast(data.GetFieldData()->GetAbstractArray(name));
  return array && array->GetNumberOfValues() > 0 ? std::string(array->GetValue(0)) : std::string();
}

template <class Target>
void read_field_tags(vtkPolyData& data, Target& target) {
  if (const auto space = parse_space(field_text(data, "SPACE"))) target.space = *space;
  if (const auto unit = parse_length_unit(field_text(data, "UNIT"))) target.unit = *unit;
}

Vec3 point(vtkPolyData& data, vtkIdType i) {
  Vec3 p;
  data.GetPoint(i, p.data());
  return p;
}

vtkDataArray* find_radius(vtkPolyData& data, const std::string& wanted, const std::string& source) {
  vtkPointData* point_data = data.GetPointData();
  for (const auto& name : radius_names(wanted)) {
    vtkDataArray* array = point_data->GetArray(name.c_str());
    if (!array) continue;
    if (array->GetNumberOfComponents() == 1 && array->GetNumberOfTuples() == data.GetNumberOfPoints()) return array;
    throw InvalidInput(source + ": the point array " + name + " must hold one number for every point");
  }
  std::vector<std::string> present;
  for (int a = 0; a < point_data->GetNumberOfArrays(); ++a) {
    if (const char* name = point_data->GetArrayName(a)) present.emplace_back(name);
  }
  fail_without_radius(source, wanted, present);
}

constexpr std::array<std::pair<const char*, const char*>, 3> kPointNames = {
    {{"radius", "MaximumInscribedSphereRadius"}, {"distance", "Distance"}, {"group", "GroupIds"}}};
constexpr std::array<std::pair<const char*, const char*>, 2> kCellNames = {
    {{"quality", "Quality"}, {"group", "GroupIds"}}};

template <std::size_t N>
std::string to_vtk(const std::array<std::pair<const char*, const char*>, N>& names, const std::string& name) {
  for (const auto& [ours, theirs] : names) {
    if (name == ours) return theirs;
  }
  return name;
}

template <std::size_t N>
std::string from_vtk(const std::array<std::pair<const char*, const char*>, N>& names, const std::string& name) {
  for (const auto& [ours, theirs] : names) {
    if (name == theirs) return ours;
  }
  return name;
}

/// The arrays of one number per element, picked by `element_of` for every element kept.
template <class Names>
std::vector<MeshAttribute> read_attributes(vtkFieldData& arrays, const Names& names, const std::vector<vtkIdType>& kept,
                                           vtkIdType count) {
  std::vector<MeshAttribute> result;
  for (int a = 0; a < arrays.GetNumberOfArrays(); ++a) {
    vtkDataArray* array = arrays.GetArray(a);
    if (!array || !array->GetName() || array->GetNumberOfComponents() != 1 || array->GetNumberOfTuples() != count)
      continue;
    const int type = array->GetDataType();
    MeshAttribute attribute{from_vtk(names, array->GetName()), {}, type != VTK_FLOAT && type != VTK_DOUBLE};
    attribute.values.reserve(kept.size());
    for (const vtkIdType i : kept) attribute.values.push_back(array->GetComponent(i, 0));
    result.push_back(std::move(attribute));
  }
  return result;
}

void add_text(vtkPolyData& data, const char* name, const std::string& value) {
  if (value.empty()) return;
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->InsertNextValue(one_line(value));
  data.GetFieldData()->AddArray(array);
}

template <class Metadata>
void add_metadata(vtkPolyData& data, const Metadata& metadata) {
  add_text(data, "SPACE", "LPS");
  add_text(data, "UNIT", "mm");
  add_text(data, "Generator", metadata.generator);
  add_text(data, "Options", metadata.options);
  add_text(data, "Input", metadata.input_name);
  add_text(data, "InputSHA256", metadata.input_sha256);
}

void add_points(vtkPolyData& data, std::size_t count, const auto& position) {
  vtkNew<vtkPoints> points;
  points->SetDataTypeToDouble();
  points->SetNumberOfPoints(static_cast<vtkIdType>(count));
  for (std::size_t i = 0; i < count; ++i) points->SetPoint(static_cast<vtkIdType>(i), position(i).data());
  data.SetPoints(points);
}

void add_numbers(vtkFieldData& target, const std::string& name, const std::vector<double>& values, bool integer) {
  const auto fill = [&](auto& array, auto convert) {
    array.SetName(name.c_str());
    array.SetNumberOfValues(static_cast<vtkIdType>(values.size()));
    for (std::size_t i = 0; i < values.size(); ++i) array.SetValue(static_cast<vtkIdType>(i), convert(values[i]));
    target.AddArray(&array);
  };
  if (integer) {
    vtkNew<vtkIntArray> array;
    fill(*array, [](double x) { return static_cast<int>(x); });
  } else {
    vtkNew<vtkDoubleArray> array;
    fill(*array, [](double x) { return x; });
  }
}

void write_poly_data(std::ostream& out, vtkPolyData& data) {
  const VtkMessages messages;
  vtkNew<vtkXMLPolyDataWriter> writer;
  writer->SetInputData(&data);
  writer->SetDataModeToBinary();
  writer->WriteToOutputStringOn();
  if (writer->Write() != 1 || !messages.text().empty()) {
    throw WriteError("VTK cannot write the file: " + first_message(messages.text()));
  }
  out << writer->GetOutputString();
}

}  // namespace

RawCenterline parse_centerline_vtp(std::string_view content, const std::string& source,
                                   const std::string& radius_array) {
  const auto data = read_poly_data(content, source);
  vtkDataArray* radius = find_radius(*data, radius_array, source);
  PolyLines poly_lines;
  for (vtkIdType i = 0; i < data->GetNumberOfPoints(); ++i) {
    poly_lines.points.push_back({point(*data, i), radius->GetComponent(i, 0)});
  }
  poly_lines.lines = Cells(data->GetLines(), data->GetNumberOfPoints(), source, "line cell").lists();
  poly_lines.vertices = Cells(data->GetVerts(), data->GetNumberOfPoints(), source, "vertex cell").lists();
  RawCenterline raw = to_raw_centerline(poly_lines, source);
  read_field_tags(*data, raw);
  return raw;
}

void write_centerline_vtp(std::ostream& out, const Centerline& centerline, const CenterlineMetadata& metadata) {
  vtkNew<vtkPolyData> data;
  const auto& nodes = centerline.nodes();
  add_points(*data, nodes.size(), [&](std::size_t i) { return nodes[i].position; });
  std::vector<double> radius;
  for (const auto& node : nodes) radius.push_back(node.radius);
  add_numbers(*data->GetPointData(), "MaximumInscribedSphereRadius", radius, false);
  vtkNew<vtkCellArray> lines;
  for (const auto& [a, b] : centerline.segments()) {
    const vtkIdType ids[2] = {a, b};
    lines->InsertNextCell(2, ids);
  }
  data->SetLines(lines);
  vtkNew<vtkCellArray> spheres;
  for (Index n = 0; n < nodes.size(); ++n) {
    const vtkIdType id = n;
    if (centerline.degree(n) == 0) spheres->InsertNextCell(1, &id);
  }
  if (spheres->GetNumberOfCells() > 0) data->SetVerts(spheres);
  add_metadata(*data, metadata);
  write_poly_data(out, *data);
}

LoadedSurface parse_surface_vtp(std::string_view content, const std::string& source) {
  const auto data = read_poly_data(content, source);
  const vtkIdType point_count = data->GetNumberOfPoints();
  const Cells polygons(data->GetPolys(), point_count, source, "polygon");
  const Cells strips(data->GetStrips(), point_count, source, "strip");
  LoadedSurface surface;
  read_field_tags(*data, surface);
  std::vector<vtkIdType> kept;
  for (vtkIdType i = 0; i < point_count; ++i) {
    surface.mesh.vertices.push_back(point(*data, i));
    kept.push_back(i);
  }
  surface.attributes.vertex = read_attributes(*data->GetPointData(), kPointNames, kept, point_count);
  // Cells of a vtkPolyData are numbered vertices, lines, polygons, strips.
  const vtkIdType first_cell = data->GetNumberOfVerts() + data->GetNumberOfLines();
  FaceCollector faces(surface, source);
  std::vector<vtkIdType> cell_of_face;
  for (std::size_t c = 0; c < polygons.size(); ++c) {
    cell_of_face.push_back(first_cell + static_cast<vtkIdType>(c));
    faces.add({polygons[c].begin(), polygons[c].end()}, "polygon " + std::to_string(c));
  }
  for (std::size_t c = 0; c < strips.size(); ++c) {
    const auto strip = strips[c];
    for (std::size_t i = 2; i < strip.size(); ++i) {
      cell_of_face.push_back(first_cell + static_cast<vtkIdType>(polygons.size() + c));
      const bool odd = i % 2 == 1;
      faces.add({strip[i - (odd ? 1 : 2)], strip[i - (odd ? 2 : 1)], strip[i]}, "strip " + std::to_string(c));
    }
  }
  faces.finish();
  kept.clear();
  for (const Index f : faces.face_of_triangle()) kept.push_back(cell_of_face[f]);
  surface.attributes.face = read_attributes(*data->GetCellData(), kCellNames, kept, data->GetNumberOfCells());
  warn_without_tags(surface, source);
  return surface;
}

void write_surface_vtp(std::ostream& out, const TriMesh& mesh, const MeshAttributes& attributes,
                       const SurfaceMetadata& metadata) {
  vtkNew<vtkPolyData> data;
  add_points(*data, mesh.vertices.size(), [&](std::size_t i) { return mesh.vertices[i]; });
  vtkNew<vtkCellArray> polygons;
  for (const auto& [a, b, c] : mesh.faces) {
    const vtkIdType ids[3] = {a, b, c};
    polygons->InsertNextCell(3, ids);
  }
  data->SetPolys(polygons);
  vtkNew<vtkFloatArray> normals;
  normals->SetName("Normals");
  normals->SetNumberOfComponents(3);
  for (const Vec3& n : vertex_normals(mesh)) normals->InsertNextTuple(n.data());
  data->GetPointData()->SetNormals(normals);
  for (const auto& a : attributes.vertex) {
    add_numbers(*data->GetPointData(), to_vtk(kPointNames, a.name), a.values, a.integer);
  }
  for (const auto& a : attributes.face)
    add_numbers(*data->GetCellData(), to_vtk(kCellNames, a.name), a.values, a.integer);
  add_metadata(*data, metadata);
  write_poly_data(out, *data);
}

}  // namespace vmesh::io
