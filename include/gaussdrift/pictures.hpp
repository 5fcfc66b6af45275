/// @file
/// How a run draws its pictures, and whether it makes an animation of them.
#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace gaussdrift {

/// `[output.pictures]`: how pictures look. What is empty or 0 is chosen.
struct PicturesSpec {
  std::optional<std::array<double, 2>> range{};  ///< of the colours, the same in all pictures
  bool log = false;                              ///< colours by the logarithm
  bool per_frame = false;                        ///< a range of its own for each picture
  std::array<int, 2> size{1280, 960};            ///< in pixels
  std::string colour_map{};                      ///< by name; empty: that of the style
  std::string field{};                           ///< of `output.fields`, drawn in place of the density; empty: none
  std::array<double, 2> view{-62, 31};           ///< of scenes: azimuth and elevation of the eye, in degrees
  std::vector<double> zoom{};  ///< a part of the domain: lower and upper end, axis by axis; empty: all
  std::string velocity{};      ///< drawn over maps: "arrows" or "streamlines"; empty: not
  bool transparent = false;    ///< no background
  bool large_type = false;     ///< for slides

  /// The same looks.
  bool operator==(const PicturesSpec&) const = default;
};

/// `output.animation`: the pictures of a run in motion.
struct AnimationSpec {
  std::string kind;           ///< gif, apng, mp4 or webm
  int frames = 200;           ///< evenly spaced over the run, with its start and its end
  double seconds = 10;        ///< that it takes
  std::array<int, 2> size{};  ///< in pixels; 0: chosen for the kind

  /// The same animation.
  bool operator==(const AnimationSpec&) const = default;
};

}  // namespace gaussdrift
