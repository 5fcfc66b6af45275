// Films of the densities of a run: one of each style, all frames with the same range of colours.
#pragma once

#include <cstddef>
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

#include "gaussdrift/case.hpp"
#include "render/film.hpp"
#include "render/film_frames.hpp"
#include "render/styles.hpp"

namespace gaussdrift::render {

struct Animation {
  std::vector<double> times{};                    // of the frames that there are
  std::function<FilmFrame(std::size_t)> frame{};  // each of them; several threads ask. Throws FileError
  std::size_t frames = 0;                         // of the film: evenly spaced in time, each the nearest that there is
  const FilmKind* kind = nullptr;
  double seconds = 10;
  std::array<int, 2> size{};  // 0: the usual one of the kind. Odd numbers get one more
  PicturesSpec looks{};
  std::string title{};
  std::string quantity{};                     // empty: that of the style, or the array
  std::function<std::string(double)> date{};  // of a time; empty: there is none
  int threads = 0;
};

/// A film of one style. `array`: what is shown in place of the density, and stands before the name of the file; empty:
/// nothing. Written whole or not at all. Throws FileError.
void make_film(const Animation& animation, const Style& style, const std::string& array,
               const std::filesystem::path& file);

/// "surface.gif", "vorticity_heatmap.mp4".
std::string film_name(const Style& style, const std::string& array, const FilmKind& kind);

/// Styles that a case has films of: those of its pictures that show densities, or the usual one.
std::vector<const Style*> film_styles(const Case& spec);

/// What films of a case show in place of the density, one after another; an empty name is the density.
std::vector<std::string> film_arrays(const Case& spec);

/// Films of the frames that a complete run in this folder has kept, images/surface.gif and so on, whose names are
/// returned. Then the frames are removed. Throws FileError; then they are still there.
std::vector<std::string> make_films_of_run(const std::filesystem::path& folder, const Case& spec, int threads);

/// Whether a run has left frames, because a film could not be made of them.
bool has_film_frames(const std::filesystem::path& folder);

}  // namespace gaussdrift::render
