// A page that shows surfaces and what was found of them, in one HTML file that needs nothing else.
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

/// A surface to look at, coloured by any of its attributes. One without any is a reference and no more.
struct PageSurface {
  std::string name;
  TriMesh mesh;
  MeshAttributes attributes;
  bool reference = false;  ///< shown in transparency around the others
};

/// A place that a click leads to.
struct PagePlace {
  std::string label, value;
  Vec3 position = Vec3::Zero();
  std::string attribute;  ///< to colour by, there; empty: as it is
  std::string surface;    ///< to show, there; empty: as it is
};

struct PageHistogram {
  std::string title, unit;
  Histogram histogram;
  Distribution distribution;
};

/// A motion of the first surface and of the centerline. Positions are packed as they come.
class PageFrames {
 public:
  /// Takes every frame of `count`, or every second, third ... and the last, so that they stay within about 16 MB.
  PageFrames(const TriMesh& mesh, const Centerline& centerline, std::size_t count);

  /// Frames come in the order of their time; the first one is at rest.
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
  std::string options;                                     ///< that stand behind the surface, where it has some
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

/// Throws Unsupported when this build cannot make pages.
void check_can_make_pages();

/// The whole page, UTF-8. Deterministic. Throws Unsupported likewise.
std::string to_html(const Page& page);

/// Throws WriteError; complete or not at all. Says where it is and how large.
void write_page(const std::filesystem::path& path, const Page& page, Console& console);

}  // namespace vmesh::tool
