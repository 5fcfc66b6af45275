#include "cli/sum_output.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <system_error>
#include <utility>

#include "cli/output_name.hpp"
#include "gaussdrift/error.hpp"
#include "write/atomic_file.hpp"
#include "write/npy_file.hpp"
#include "write/vtk_files.hpp"

namespace gaussdrift::cli {

namespace fs = std::filesystem;

namespace {

/// A stream that is closed on the way out of an error.
class Output {
 public:
  explicit Output(const fs::path& file) : stream_(std::fopen(file.c_str(), "wb")) {
    if (!stream_) throw std::system_error(errno, std::generic_category());
  }
  ~Output() {
    if (stream_) std::fclose(stream_);
  }
  Output(const Output&) = delete;
  Output& operator=(const Output&) = delete;
  std::FILE* stream() const { return stream_; }
  void close() {
    if (std::fclose(std::exchange(stream_, nullptr)) != 0) throw std::system_error(errno, std::generic_category());
  }

 private:
  std::FILE* stream_;
};

fs::path folder_of(const fs::path& file) { return file.has_parent_path() ? file.parent_path() : fs::path("."); }

/// An array has the axes of the grid, or one for the targets. Several columns are its last axis.
void write_array(const ValuesOutput& output, const Eigen::MatrixXd& values, std::FILE* out) {
  std::vector<std::size_t> shape;
  for (const sum::GridAxis& axis : output.grid) shape.push_back(axis.count);
  if (shape.empty()) shape.push_back(static_cast<std::size_t>(values.rows()));
  if (values.cols() > 1) shape.push_back(static_cast<std::size_t>(values.cols()));
  write::write_npy(out, shape, values.data());
}

void write_image(const ValuesOutput& output, const Eigen::MatrixXd& values, std::FILE* out) {
  write::Image image;
  for (std::size_t k = 0; k < output.grid.size(); ++k) {
    const sum::GridAxis& axis = output.grid[k];
    image.points[k] = axis.count;
    image.origin[k] = axis.lower;
    if (axis.count > 1) image.spacing[k] = (axis.upper - axis.lower) / static_cast<double>(axis.count - 1);
  }
  std::vector<write::ImageArray> arrays;
  for (std::size_t k = 0; k < output.columns.size(); ++k)
    arrays.push_back({output.columns[k], values.col(static_cast<Eigen::Index>(k)).data()});
  write::write_image(out, image, arrays);
}

void write_to(const ValuesOutput& output, const Eigen::MatrixXd& values, std::FILE* out) {
  switch (format_of(output.file)) {
    case ValuesFormat::table:
      return sum::write_table(output.columns, values, out);
    case ValuesFormat::npy:
      return write_array(output, values, out);
    case ValuesFormat::image:
      return write_image(output, values, out);
  }
}

}  // namespace

ValuesFormat format_of(const fs::path& out) {
  const std::string ending = known_ending(out);
  if (ending.empty() || ending == ".csv" || ending == ".txt") return ValuesFormat::table;
  if (ending == ".npy") return ValuesFormat::npy;
  if (ending == ".vti") return ValuesFormat::image;
  throw CommandLineError(fmt::format(
      "--out {}: values are written as a table in text (.csv), which ParaView, spreadsheets and NumPy read, "
      "as a NumPy array (.npy), or on a grid as an image for ParaView (.vti); give a name such as {}",
      out.string(), fs::path(out).replace_extension(".csv").string()));
}

void write_values(const ValuesOutput& output, const Eigen::MatrixXd& values) {
  const fs::path& file = output.file;
  const bool standard = file.empty() || file == "-";
  std::error_code ignored;
  const bool special = fs::exists(file, ignored) && !fs::is_regular_file(file, ignored);
  try {
    if (standard) {
      write_to(output, values, stdout);
    } else if (special) {  // a pipe or a device is written to; a rename would replace it
      Output out(file);
      write_to(output, values, out.stream());
      out.close();
    } else {
      write::remove_what_killed_processes_left(folder_of(file));
      write::write_atomically(file, [&](std::FILE* out) { write_to(output, values, out); });
    }
  } catch (const std::system_error& error) {
    if (standard && error.code() == std::errc::broken_pipe) return;  // as in: sum ... | head
    throw FileError(
        fmt::format("cannot write {}: {}", standard ? "to standard output" : file.string(), error.code().message()));
  }
}

}  // namespace gaussdrift::cli
