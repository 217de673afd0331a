#pragma once

#include <string>
#include <vector>

#include "command_line/arguments.h"
#include "page/page.h"
#include "report/summary.h"

namespace vmesh::tool {

/// Marks of one kind on a page.
constexpr std::size_t kMarksOfEach = 3;

/// A page about `title` with the command line that made it.
Page make_page(const char* verb, const std::filesystem::path& title, const CommonArguments& common);

/// `value` with three decimals.
std::string short_number(double value);
/// "0.072 / 0.256"
std::string mean_and_max(double mean, double max);

/// Selects places of a surface that are apart from each other.
class PlacesApart {
 public:
  explicit PlacesApart(const TriMesh& mesh);
  /// Takes `place` if it is apart from all taken before; returns whether it was taken.
  bool take(const Vec3& place);

 private:
  double distance_ = 0;
  std::vector<Vec3> taken_;
};

/// Adds histograms of skewness, angles, and the vertex attributes that are distances.
void add_histograms(Page& page, const PageSurface& surface);

/// Adds at most `count` separate places where an attribute's absolute value is largest, as "LABEL" with the value and
/// `unit`.
void add_largest(Page& page, const PageSurface& surface, const std::string& attribute, const std::string& label,
                 const std::string& unit, std::size_t count);

/// Adds where the surface and the reference are farthest from each other.
void add_farthest(Page& page, const Hausdorff& hausdorff);

/// Adds the largest regions that a fit left unmatched.
void add_unmatched(Page& page, const FitReport& fit, std::size_t count);

/// A summary as tables: one for its numbers and texts, one per nested object. Lists are counted; what differs between
/// runs (seconds) is left out.
std::vector<ReportTable> tables_of(const Json& summary);

}  // namespace vmesh::tool
