// What tables of points cost to read and to write: megabytes of the file a second of the processor, on one thread. The
// table has three columns of numbers with 17 digits; the file is in the cache of the system.
//   bench_tables [ROWS]     10^6 by default
#include <fmt/format.h>

#include <Eigen/Core>
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>

#include "input/points_table.hpp"
#include "sum/points_request.hpp"
#include "write/npy_file.hpp"

namespace {

namespace fs = std::filesystem;
using namespace gaussdrift;

/// The fastest of five, in seconds of the processor.
template <class Work>
double seconds(const Work& work) {
  double least = std::numeric_limits<double>::infinity();
  for (int round = 0; round < 5; ++round) {
    const std::clock_t start = std::clock();
    work();
    least = std::min(least, static_cast<double>(std::clock() - start) / CLOCKS_PER_SEC);
  }
  return least;
}

template <class Work>
void tell(const char* what, const fs::path& file, const Work& work) {
  work();  // the file is there then
  const double took = seconds(work), bytes = static_cast<double>(fs::file_size(file));
  fmt::print("{:44}{:8.0f} MB/s {:8.1f} MB\n", what, bytes / took / 1e6, bytes / 1e6);
}

template <class Write>
void write_file(const fs::path& file, const Write& write) {
  std::FILE* out = std::fopen(file.c_str(), "wb");
  if (!out) std::exit(1);
  write(out);
  std::fclose(out);
}

/// The table with other letters; its names stay, or go.
fs::path changed(const fs::path& table, const char* name, char from, const std::string& to, bool named = true) {
  std::ifstream in(table, std::ios::binary);
  std::string text(std::istreambuf_iterator<char>(in), {});
  if (!named) text.erase(0, text.find('\n') + 1);
  const fs::path file = table.parent_path() / name;
  std::ofstream out(file, std::ios::binary);
  for (const char c : text) c == from ? out << to : out << c;
  return file;
}

}  // namespace

int main(int argc, char** argv) {
  const auto rows = static_cast<Eigen::Index>(argc > 1 ? std::strtod(argv[1], nullptr) : 1e6);
  std::mt19937_64 random(1);
  std::uniform_real_distribution<double> uniform(0.001, 1);  // without exponents
  const Eigen::MatrixXd values = Eigen::MatrixXd::NullaryExpr(rows, 3, [&] { return uniform(random); });
  const fs::path folder = fs::temp_directory_path() / fmt::format("bench_tables_{}", std::random_device{}());
  fs::create_directory(folder);
  const fs::path table = folder / "t.csv", array = folder / "t.npy";
  tell("write a table, 17 digits", table, [&] {
    write_file(table, [&](std::FILE* out) { sum::write_table({"x", "y", "weight"}, values, out); });
  });
  tell("write .npy", array, [&] {
    write_file(array, [&](std::FILE* out) {
      write::write_npy(out, {static_cast<std::size_t>(rows), std::size_t{3}}, values.data());
    });
  });
  const auto read = [&](const fs::path& file, const input::PointsColumns& columns) {
    const auto points = input::read_points_table(file, input::PointsRole::sources, std::size_t{1} << 34, columns);
    if (points.size() != static_cast<std::size_t>(rows)) std::exit(1);
  };
  tell("read a table, 17 digits", table, [&] { read(table, {}); });
  tell("read one column of it and the weight", table, [&] { read(table, {.coordinates = {"x"}}); });
  const fs::path blanks = changed(table, "blanks.txt", ',', "  ");
  tell("read it with blanks between the columns", blanks, [&] { read(blanks, {}); });
  const fs::path labels = changed(table, "labels.csv", ',', ",\"a, b\",", false);
  tell("read it between labels in quotation marks", labels, [&] {
    read(labels, {.coordinates = {"1", "3"}, .weight = "5"});
  });
  const fs::path fortran = changed(table, "fortran.txt", ',', "D+00 ", false);
  tell("read it with exponents of Fortran", fortran, [&] {
    read(fortran, {.coordinates = {"1", "2"}, .weight = "3"});
  });
  tell("read .npy", array, [&] { read(array, {.weight = "3"}); });
  fs::remove_all(folder);
}
