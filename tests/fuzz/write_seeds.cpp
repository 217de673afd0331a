// write_seeds READER FOLDER: the seeds of a reader as files, for a fuzzer to start from.
#include <filesystem>
#include <fstream>
#include <iostream>

#include "readers.h"

int main(int argc, char** argv) {
  if (argc != 3) {
    std::cerr << "usage: write_seeds READER FOLDER; readers:";
    for (const vmesh::testing::Reader& reader : vmesh::testing::readers()) std::cerr << ' ' << reader.name;
    std::cerr << "\n";
    return 2;
  }
  const std::filesystem::path folder = argv[2];
  std::filesystem::create_directories(folder);
  const vmesh::testing::Reader& reader = vmesh::testing::reader_named(argv[1]);
  int number = 0;
  for (const std::string& seed : reader.seeds()) {
    std::ofstream out(folder / ("seed" + std::to_string(number++) + std::string(reader.ending)), std::ios::binary);
    if (!(out << seed)) return 1;
  }
  return 0;
}
