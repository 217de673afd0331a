// A page that shows surfaces and the findings about them, in one self-contained HTML file.
#pragma once

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

#include "vmesh/centerline/centerline.h"
#include "vmesh/mesh/tri_mesh.h"
#include "vmesh/quality/distribution.h"

#include "command_line/console.h"
#include "report/report_table.h"

namespace vmesh::tool {

/// A surface to show, coloured by any of its attributes. One without attributes only serves as a reference.
struct PageSurface {
  std::string name;
  TriMesh mesh;
  MeshAttributes attributes;
  bool reference = false;  ///< shown in transparency around the others
};

/// A position that a click leads to.
struct PagePlace {
  std::string label, value;
  Vec3 position = Vec3::Zero();
  std::string attribute;  ///< to colour by; empty: unchanged
  std::string surface;    ///< to show; empty: unchanged
};

struct PageHistogram {
  std::string title, unit;
  Histogram histogram;
  Distribution distribution;
};

/// A motion of the first surface and of the centerline. Positions are encoded as they arrive.
class PageFrames {
 public:
  /// Keeps all of `count` frames, or every second, third ... and the last, to stay within about 16 MB.
  PageFrames(const TriMesh& mesh, const Centerline& centerline, std::size_t count);

  /// Frames are added in order of time; the first one is at rest.
  void add(double time_s, const std::vector<Vec3>& vertices, const std::vector<Vec3>& nodes);

  std::size_t every() const { return every_; }
  const std::vector<double>& time_s() const { return time_s_; }
  const std::vector<std::string>& packed() const { return packed_; }

 private:
  std::size_t count_, every_ = 1, seen_ = 0;
  Vec3 low_ = Vec3::Zero();
  double step_ = 1;
  std::vector<std::int64_t> last_;
  std::vector<double> time_s_;
  std::vector<std::string> packed_;
};

struct Page {
  std::string title;  ///< of the file it is about
  std::string verb;
  std::string command_line;
  std::string options;                                     ///< with which the surface was made, if known
  std::vector<std::pair<std::string, std::string>> facts;  ///< name and value, the most important first
  std::vector<std::string> warnings;
  std::vector<PageSurface> surfaces;
  std::optional<Centerline> centerline;
  std::vector<PagePlace> places;  ///< worst first
  std::vector<PageHistogram> histograms;
  std::vector<ReportTable> tables;
  std::vector<std::pair<std::string, std::string>> pictures;  ///< caption and SVG
  std::optional<PageFrames> frames;
};

/// The whole page, UTF-8. Deterministic. A build without three.js makes no pages: check_outputs() refuses them.
std::string to_html(const Page& page);

/// Writes the page, completely or not at all, and reports its name and size. Throws WriteError.
void write_page(const std::filesystem::path& path, const Page& page, Console& console);

}  // namespace vmesh::tool
