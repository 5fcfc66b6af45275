// The pictures of a run: one of each wanted style at every output time, all with the same colour range.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/frame.hpp"

namespace gaussdrift::render {

/// Bytes of densities that are kept for drawing again, at most.
constexpr std::size_t most_kept_bytes = 256'000'000;

struct SeriesOptions {
  std::function<void(const std::string&)> warn{};  // gets lines for people
  std::function<std::string(double t)> date{};     // of an output, shown beside its time; empty: there is none
  std::string tracer{};  // the pictures show this named density, not that of all: images/A_surface_0000.png, ...
  std::string label{};   // what the density is called; empty: as the style does
  double sphere = 0;     // of the lattice of every density
  PicturesSpec looks{};  // a zoom or a velocity where all styles can show them
  bool beside = false;   // drawn by another thread while the run goes on, of copies of the densities
  std::size_t most_bytes = most_kept_bytes;
  bool run_writes_densities = false;  // in its density files
};

/// images/surface_0000.png, ... The range is the given one, or that of the first frame, with round ends. If a later frame leaves that by
/// more than a hundredth, all pictures are drawn again at the end, with the wider range (in 3D from every second,
/// third, ... point where an axis has more than 128). Errors have a range of their own, as far below 0 as above;
/// styles that show them need frames with an exact density. What is drawn again and is no longer in memory, because there
/// was too much or an earlier process drew it, is read from the density files of the run in `folder`, or from state/pictures/
/// where it writes none. Where these are gone, the pictures stay as they are, and a warning says so.
std::unique_ptr<Observer> picture_series(const std::filesystem::path& folder, const std::vector<PictureStyle>& styles,
                                         std::string title, SeriesOptions options = {});

}  // namespace gaussdrift::render
