// Reads a centerline file and reports its problems and the result of cleaning.
#include <cstdio>

#include "vmesh/centerline/validation.h"
#include "vmesh/core/error.h"
#include "vmesh/io/centerline_io.h"

int main(int argc, char** argv) {
  if (argc != 2) {
    std::fprintf(stderr, "usage: read_and_clean CENTERLINE\n");
    return 2;
  }
  try {
    // Units and frame first: numbers in mm and LPS from here on.
    std::vector<std::string> warnings;
    const vmesh::RawCenterline raw =
        vmesh::convert_to_internal(vmesh::read_centerline(argv[1]), vmesh::LengthUnit::mm, std::nullopt, warnings);
    for (const std::string& warning : warnings) std::printf("warning: %s\n", warning.c_str());
    for (const vmesh::CenterlineProblem& problem : vmesh::validate(raw.nodes, raw.segments))
      std::printf("problem: %s\n", problem.message.c_str());

    const vmesh::CleanedCenterline cleaned = vmesh::clean(raw);
    for (const std::string& line : cleaned.report.summary()) std::printf("cleaned: %s\n", line.c_str());
    const vmesh::Centerline& centerline = cleaned.centerline;
    std::printf("%zu nodes, %zu segments, %zu components, %zu loops\n", centerline.nodes().size(),
                centerline.segments().size(), centerline.component_count(), centerline.cycle_rank());
  } catch (const vmesh::Error& error) {
    std::fprintf(stderr, "read_and_clean: %s\n", error.what());
    return 1;
  }
}
