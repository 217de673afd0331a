#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "command_line/arguments.h"
#include "page/page.h"
#include "report/summary.h"

namespace vmesh::tool {

/// A page about `title` with the command line that made it.
Page make_page(const char* verb, const std::filesystem::path& title, const CommonArguments& common);

/// With three digits after the point.
std::string short_number(double value);
/// "0.072 / 0.256"
std::string mean_and_max(double mean, double max);
std::string point_text(const Vec3& p);

/// Tells places of a surface apart.
class PlacesApart {
 public:
  explicit PlacesApart(const TriMesh& mesh);
  /// Whether `place` is apart from all that were taken; then it is taken too.
  bool take(const Vec3& place);

 private:
  double distance_ = 0;
  std::vector<Vec3> taken_;
};

/// Skewness of faces, angles, and what attributes of vertices are distances.
void add_histograms(Page& page, const PageSurface& surface);

/// Where an attribute of the surface is largest, signs aside, at most `count` places apart from each other, as
/// "LABEL" with the value and `unit`.
void add_largest(Page& page, const PageSurface& surface, std::string_view attribute, const std::string& label,
                 const std::string& unit, std::size_t count);

/// What a fit left unmatched, the largest parts.
void add_unmatched(Page& page, const FitReport& fit, std::size_t count);

/// A summary as tables: one of its numbers and words, one per object in it. What it lists is counted; what differs from
/// run to run (seconds) is left out.
std::vector<ReportTable> tables_of(const Json& summary);

}  // namespace vmesh::tool
