// Files of data on grids, written as text into a folder of their own.
#pragma once

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>

#include "cases.hpp"
#include "gaussdrift/read_case.hpp"
#include "read/grid_file.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::input {

namespace fs = std::filesystem;

/// As inline arrays of binary files are written.
inline std::string in_base64(const std::string& bytes) {
  constexpr const char* digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned bits = 0;
    for (std::size_t k = 0; k < 3; ++k)
      bits = bits << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    for (std::size_t k = 0; k < 4; ++k) text += i + k > bytes.size() ? '=' : digits[bits >> (18 - 6 * k) & 63];
  }
  return text;
}

class GridFile : public ::testing::Test {
 protected:
  /// nx x ny (x nz) points on [-1, 1]^d with one array, values as text.
  void write_vti(const std::string& name, int nx, int ny, int nz, const std::string& array, int components,
                 const std::string& values, const std::string& kind = "PointData") const {
    std::ofstream(folder_ / name)
        << "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\"><ImageData WholeExtent=\"0 "
        << nx - 1 << " 0 " << ny - 1 << " 0 " << nz - 1 << "\" Origin=\"-1 -1 " << (nz > 1 ? -1 : 0) << "\" Spacing=\""
        << 2. / (nx - 1) << " " << 2. / (ny - 1) << " " << (nz > 1 ? 2. / (nz - 1) : 1) << "\"><Piece Extent=\"0 "
        << nx - 1 << " 0 " << ny - 1 << " 0 " << nz - 1 << "\"><" << kind << "><DataArray type=\"Float64\" Name=\""
        << array << "\" NumberOfComponents=\"" << components << "\" format=\"ascii\">" << values << "</DataArray></"
        << kind << "></Piece></ImageData></VTKFile>\n";
  }

  /// f at the points of an n x n grid on [-1, 1]^2, two components.
  template <class F>
  static std::string sampled(int n, F f) {
    std::ostringstream text;
    text.precision(17);
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        const auto [u, v] = f(-1 + 2. * i / (n - 1), -1 + 2. * j / (n - 1));
        text << u << " " << v << " ";
      }
    return text.str();
  }

  void write_series(const std::string& name, const std::string& entries) const {
    std::ofstream(folder_ / name) << "<VTKFile type=\"Collection\"><Collection>" << entries
                                  << "</Collection></VTKFile>\n";
  }

  /// An image of nx x ny points on [0, nx - 1] x [0, ny - 1] with these elements inside its one piece.
  void write_image(const std::string& name, int nx, int ny, const std::string& inside,
                   const std::string& attributes = "Origin=\"0 0 0\" Spacing=\"1 1 1\"") const {
    const std::string extent = fmt::format("0 {} 0 {} 0 0", nx - 1, ny - 1);
    write_pieces(name, extent, attributes, fmt::format("<Piece Extent=\"{}\">{}</Piece>", extent, inside));
  }
  void write_pieces(const std::string& name, const std::string& extent, const std::string& attributes,
                    const std::string& pieces) const {
    std::ofstream(folder_ / name) << fmt::format(
        "<VTKFile type=\"ImageData\" version=\"1.0\" byte_order=\"LittleEndian\">\n<ImageData WholeExtent=\"{}\" {}>\n"
        "{}\n</ImageData></VTKFile>\n",
        extent, attributes, pieces);
  }
  /// A rectilinear grid; `inside` stands before its coordinates.
  void write_vtr(const std::string& name, const std::string& x, const std::string& y, const std::string& inside,
                 const std::string& type = "Float64") const {
    const auto count = [](const std::string& text) { return std::count(text.begin(), text.end(), ' '); };
    const std::string extent = fmt::format("0 {} 0 {} 0 0", count(x), count(y));
    std::string axes;
    for (const std::string& values : {x, y, std::string("0")})
      axes += fmt::format("<DataArray type=\"{}\" Name=\"axis\" format=\"ascii\">{}</DataArray>", type, values);
    std::ofstream(folder_ / name) << fmt::format(
        "<VTKFile type=\"RectilinearGrid\" version=\"1.0\" byte_order=\"LittleEndian\"><RectilinearGrid "
        "WholeExtent=\"{0}\"><Piece "
        "Extent=\"{0}\">{1}<Coordinates>{2}</Coordinates></Piece></RectilinearGrid></VTKFile>\n",
        extent, inside, axes);
  }
  /// <PointData> (or <CellData>) with arrays; an array is "name", components, values.
  static std::string data(const std::string& arrays, const std::string& kind = "PointData") {
    return fmt::format("<{0}>{1}</{0}>", kind, arrays);
  }
  static std::string array(const std::string& name, int components, const std::string& values,
                           const std::string& type = "Float64", const std::string& more = "") {
    return fmt::format(
        "<DataArray type=\"{}\" Name=\"{}\" NumberOfComponents=\"{}\" format=\"ascii\" {}>{}</DataArray>", type, name,
        components, more, values);
  }

  /// A request for a vector in 2D.
  static read::GridRequest vector_of(const std::string& name = "", read::Missing missing = read::Missing::error) {
    read::GridRequest request{.least_components = 2, .most_components = 3, .missing = missing};
    if (!name.empty()) request.arrays = {name};
    return request;
  }
  /// What reading says, and its remedy; empty if it succeeds.
  std::string refusal(const std::string& name, const read::GridRequest& request) const {
    try {
      read::read_grid(folder_ / name, request);
    } catch (const read::GridFileError& error) {
      return error.what() + std::string("\n") + error.remedy();
    }
    return "";
  }

  std::string case_with(const std::string& velocity) const { return with(cone, "u = [\"-y\", \"x\"]", velocity); }

  std::string message(const std::string& velocity) const {
    try {
      parse_case(case_with(velocity), folder_ / "cone.toml", {"time.end=1", "output.times=[1]"});
    } catch (const CaseError& error) {
      return error.what();
    }
    return "";
  }

  ScratchFolder folder_;
};

}  // namespace gaussdrift::input
