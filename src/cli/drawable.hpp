// What `gaussdrift render` draws: outputs of a run, a file, frames that a run has kept, or the density of a case at its start.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "gaussdrift/frame.hpp"

namespace gaussdrift::cli {

struct Drawable {
  std::string title;
  std::string label = "density";              // what the density is called
  std::vector<std::optional<double>> times;   // one of each density
  std::vector<std::size_t> numbers;           // of them, for names of files
  std::function<std::string(double)> date{};  // of a time; empty: there is none
  /// A density with the field in place of it, and with these vectors as fields. Several threads may ask. Throws FileError.
  std::function<DensityGrid(std::size_t, const std::string& field, const std::vector<std::string>& vectors)> density;
};

/// `locked`: this process has locked the folder. Throws FileError, CommandLineError.
Drawable outputs_to_draw(const std::filesystem::path& place, bool locked);

/// Frames for an animation that a run could not make. Their fields are those that it has kept.
Drawable frames_to_draw(const std::filesystem::path& folder);

/// The density of a case at its start, without a run. Throws InputError.
Drawable start_to_draw(const std::filesystem::path& file);

}  // namespace gaussdrift::cli
