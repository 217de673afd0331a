#include <set>
#include <sstream>

#include <nlohmann/json.hpp>

#include "run_vmesh.h"

namespace vmesh::testing {
namespace {

/// The column "skewness mean" of a table has numbers of at least three digits whose decimal points are below each
/// other.
void expect_brief_and_aligned(const std::string& table) {
  std::istringstream lines(table);
  std::string line;
  std::getline(lines, line);
  const std::string heading = "skewness mean";
  const std::size_t column = line.find(heading);
  std::set<std::size_t> points, lengths;
  while (std::getline(lines, line)) {
    std::string number;
    std::istringstream(line.substr(column, heading.size())) >> number;
    points.insert(line.find('.', column));
    lengths.insert(number.substr(number.find_first_of("123456789")).size());
  }
  EXPECT_EQ(points.size(), 1u) << table;
  EXPECT_EQ(lengths, std::set<std::size_t>{3}) << table;  // digits from the first that is not 0: skewness is below 1
}

class Tradeoff : public CommandTest {
 protected:
  Tradeoff() { write_y("y.swc"); }
};

TEST_F(Tradeoff, WritesReportPlotAndSummary) {
  const Outcome run =
      vmesh({"tradeoff", "@y.swc", "--samples", "500", "--report", "@r.md", "--plot", "@p.svg", "--json", "@s.json"});
  ASSERT_EQ(run.exit_code, 0) << run.err;
  const nlohmann::json summary = nlohmann::json::parse(read("s.json"));
  EXPECT_EQ(summary.at("schema"), "vmesh.tradeoff/1");
  std::set<std::string> curves;
  for (const auto& point : summary.at("points")) {
    curves.insert(point.at("curve"));
    EXPECT_GT(point.at("error_mm").at("mean"), 0.0);
    EXPECT_GE(point.at("error_mm").at("max"), point.at("error_mm").at("mean"));
  }
  const std::set<std::string> expected = {"around",
                                          "around, blend 0",
                                          "beta, single seed",
                                          "blend",
                                          "max-error",
                                          "max-error in mm, elongation 16",
                                          "max-error, elongation 16",
                                          "max-error, elongation 4",
                                          "vertices, elongation 16",
                                          "sweeps",
                                          "truncated cones",
                                          "marching cubes",
                                          "marching cubes, decimated",
                                          "marching cubes, quadric decimation"};
  EXPECT_EQ(curves, expected);
  EXPECT_NE(read("r.md").find("| around "), std::string::npos);
  EXPECT_NE(read("r.md").find("vmesh against marching cubes"), std::string::npos);
  EXPECT_EQ(read("p.svg").rfind("<svg", 0), 0u);
  EXPECT_NE(run.out.find("best for vertices"), std::string::npos);
  expect_brief_and_aligned(run.out.substr(run.out.find("  curve"), run.out.find("\n\n") - run.out.find("  curve")));
}

TEST_F(Tradeoff, RefusesAPlotItCannotDraw) {
  const Outcome run = vmesh({"tradeoff", "@y.swc", "--plot", "@p.png"});
  EXPECT_EQ(run.exit_code, 4);
  EXPECT_NE(run.err.find(".svg"), std::string::npos) << run.err;
}

}  // namespace
}  // namespace vmesh::testing
