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
#include <vtkXMLPolyDataWriter.h>

#include "end_section_arrays.h"
#include "formats.h"
#include "text.h"
#include "vtp_names.h"

namespace vmesh::io {
namespace {

/// Collects VTK's error and warning messages.
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

/// During its lifetime, VTK's messages go to text() instead of the terminal. VTK's output window and log level are
/// process-wide, so only one may exist at a time; both are restored at the end.
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

void add_text(vtkPolyData& data, const char* name, const std::string& value) {
  if (value.empty()) return;
  vtkNew<vtkStringArray> array;
  array->SetName(name);
  array->InsertNextValue(one_line(value));
  data.GetFieldData()->AddArray(array);
}

template <class Metadata>
void add_metadata(vtkPolyData& data, const Metadata& metadata) {
  add_text(data, "SPACE", std::string(to_string(metadata.space)));
  add_text(data, "UNIT", std::string(to_string(metadata.unit)));
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

void add_numbers(vtkFieldData& target, const std::string& name, const std::vector<double>& values, bool integer,
                 int components = 1) {
  const auto fill = [&](auto& array, auto convert) {
    array.SetName(name.c_str());
    array.SetNumberOfComponents(components);
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

void write_centerline_vtp(std::ostream& out, const Centerline& centerline, const CenterlineMetadata& metadata,
                          const std::vector<EndSection>& sections) {
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
  for (const FieldArray& array : end_section_arrays(sections))
    add_numbers(*data->GetFieldData(), array.name, array.values, array.integer, array.components);
  if (!metadata.segment_labels.empty()) {
    std::vector<double> labels(static_cast<std::size_t>(spheres->GetNumberOfCells()), -1);  // cells before the lines
    labels.insert(labels.end(), metadata.segment_labels.begin(), metadata.segment_labels.end());
    add_numbers(*data->GetCellData(), "Label", labels, false);
  }
  add_metadata(*data, metadata);
  write_poly_data(out, *data);
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
  // The attribute by which a viewer colours initially.
  if (!attributes.vertex.empty())
    data->GetPointData()->SetActiveScalars(to_vtk(kPointNames, attributes.vertex.front().name).c_str());
  if (!attributes.face.empty())
    data->GetCellData()->SetActiveScalars(to_vtk(kCellNames, attributes.face.front().name).c_str());
  add_metadata(*data, metadata);
  write_poly_data(out, *data);
}

}  // namespace vmesh::io
