// The frames that a page plays: outputs of a run, small enough for one file that is sent by mail. They lie in
// report.frames, and in the page itself.
#pragma once

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

#include "base/state_bytes.hpp"
#include "gaussdrift/density_grid.hpp"
#include "report/stream.hpp"

namespace gaussdrift::report {

constexpr const char* reel_file = "report.frames";

struct ReelFrame {
  std::uint64_t output = 0;  // of the run, from 0
  double time = 0;           // that the clock of the case shows
  std::string date{};        // of that time; empty: there is none
  std::vector<Stream> streams{};
};

/// Of every so many points of each axis.
Stream stream_on_grid(std::string name, const Lattice& lattice, const std::vector<double>& values, std::size_t every);

/// Bounded: where the frames take more bytes than they may, only every second, fourth, ... output is kept, and the last.
/// Where that would leave few, every second point of the grid goes instead. What is kept depends on the outputs alone.
class Reel {
 public:
  /// `dimension` 0: nothing yet.
  explicit Reel(std::size_t most_bytes) : most_bytes_(most_bytes) {}

  /// Values on the grid of the run, as a stream of the points that the page shows.
  Stream on_grid(std::string name, const Lattice& lattice, const std::vector<double>& values);
  /// Outputs come in their order.
  void add(ReelFrame frame);
  /// The run goes on after so many outputs.
  void keep_first(std::size_t outputs);
  /// Throws std::out_of_range for bytes that are not those of a reel.
  void pass(base::StateBytes& bytes);

  const std::vector<ReelFrame>& frames() const { return frames_; }
  /// The grid of the run; of no points before the first frame.
  const Lattice& lattice() const { return lattice_; }
  std::size_t every_output() const { return every_output_; }
  std::size_t every_point() const { return every_point_; }
  std::size_t bytes() const { return bytes_; }

  /// The density, or what else is called so, of a frame, on the grid of the page. Throws FileError: it is not there.
  DensityGrid density(const ReelFrame& frame, const std::string& name) const;

  /// "gdreel1\n", the length of the header as 8 hexadecimal digits and "\n", the header as JSON, the bytes of all streams.
  std::string text() const;
  /// Throws FileError where `text` is none. It may be anybody's.
  static Reel from_text(const std::string& text);

 private:
  void check() const;

  std::size_t most_bytes_, bytes_ = 0;
  std::size_t every_output_ = 1, every_point_ = 0;
  Lattice lattice_{.points = {0, 0, 0}};
  std::vector<ReelFrame> frames_;
};

}  // namespace gaussdrift::report
