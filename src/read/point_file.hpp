// The points of a ParaView file of PolyData (.vtp): their places, and the arrays at them.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace gaussdrift::read {

class PointFile {
 public:
  /// Reads what the file has, but not its arrays. Throws GridFileError: no such file, damaged, more than one piece.
  explicit PointFile(const std::filesystem::path& file);
  ~PointFile();
  PointFile(const PointFile&) = delete;
  PointFile& operator=(const PointFile&) = delete;

  std::size_t size() const;
  /// "x", "y", "z" and the arrays at the points: those of one component by their names, the components of the others as
  /// ParaView calls them in tables: "u:0", "u:1", "u:2".
  const std::vector<std::string>& columns() const;
  /// The numbers of these columns as [point][column]. Nothing is reserved before the file is known to hold them. Throws
  /// GridFileError: an array that is damaged.
  std::vector<double> read(const std::vector<std::size_t>& columns);
  /// Do all points have z = 0? They are in a plane then, and so ParaView wants it.
  bool is_flat();

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace gaussdrift::read
