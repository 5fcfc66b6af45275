// The densities of an animation's frames, kept in state/animation/ until the film is made of them: a film has one range of
// colours, which is known when the run has ended.
#pragma once

#include <cstddef>
#include <filesystem>
#include <memory>
#include <string>

#include "gaussdrift/frame.hpp"

namespace gaussdrift::render {

/// A frame of a film.
struct FilmFrame {
  double time = 0;  // that the clock of the case shows
  DensityGrid density;
};

/// As bytes, with a check sum. Numbers keep 12 bits behind the first, and those below 1e-12 of the largest become 0.
std::string bytes_of(const FilmFrame& frame);
/// Throws std::out_of_range if they are damaged.
FilmFrame film_frame_of(const std::string& bytes);

/// Its file in the folder of a run.
std::filesystem::path film_frame_file(const std::filesystem::path& folder, std::size_t number);
/// Throws FileError where it is not there or damaged.
FilmFrame read_film_frame(const std::filesystem::path& folder, std::size_t number);
/// All of them, unless a checkpoint stands beside them: a run that goes on needs them.
void remove_film_frames(const std::filesystem::path& folder);

/// Keeps the frames of a run.
std::unique_ptr<Observer> film_frames(const std::filesystem::path& folder);

}  // namespace gaussdrift::render
