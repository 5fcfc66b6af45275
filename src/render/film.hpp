// The catalogue of films: kinds of files that hold pictures in motion. A kind is one object: its name and meaning, the size
// that it has by default, why it cannot be made here, and its maker. To add one: its file, and its line in films.cpp.
#pragma once

#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

#include "base/catalogue.hpp"
#include "render/image.hpp"

namespace gaussdrift::render {

struct Reel {
  int width = 0, height = 0;
  std::size_t frames = 0;
  double seconds = 10;  // that they take together
  /// A frame, opaque. Each is asked for once and in order, after `sample` of them to find colours.
  std::function<Image(std::size_t)> frame;
  std::function<Image(std::size_t)> sample;

  /// When frame i begins, in so many parts of a second. Rounding does not add up.
  long begin(std::size_t i, double parts_of_a_second) const;
};

struct FilmKind {
  struct About {
    std::string_view name;     // in a case, and the ending of the file
    std::string_view meaning;  // one line
  } about;
  std::array<int, 2> size{640, 480};  // by default
  double bytes_of_pixel = 0.2;        // about, for predictions
  /// Empty if such a film can be made here, else the reason and the remedy.
  std::string (*missing)() = [] { return std::string(); };
  /// Writes all of a film. Throws FileError, or std::system_error with what the system says.
  void (*write)(const Reel& reel, std::FILE* file) = nullptr;
};

/// In the order of docs/cases.md. The first is what `true` means.
const std::vector<FilmKind>& film_kinds();

/// Throws std::out_of_range if no kind is called so.
const FilmKind& find_film_kind(std::string_view name);

/// Writes the film whole or not at all. Throws FileError.
void write_film(const FilmKind& kind, const Reel& reel, const std::filesystem::path& file);

/// Throws std::system_error where the disk does not take it.
void put_bytes(std::FILE* file, std::string_view bytes);

/// The smallest rectangle with all pixels in which two lists of pixels differ; one pixel if they are the same. Pixels are
/// counted from the lower left.
struct Changed {
  int left = 0, bottom = 0, columns = 1, rows = 1;
};
template <class Pixel>
Changed changed(const std::vector<Pixel>& before, const std::vector<Pixel>& after, int width, int height) {
  int left = width, right = -1, bottom = height, top = -1;
  for (int y = 0; y < height; ++y) {
    const Pixel* a = before.data() + static_cast<std::ptrdiff_t>(y) * width;
    const Pixel* b = after.data() + static_cast<std::ptrdiff_t>(y) * width;
    int first = 0, last = width - 1;
    while (first < width && a[first] == b[first]) ++first;
    if (first == width) continue;
    while (a[last] == b[last]) --last;
    left = first < left ? first : left, right = last > right ? last : right;
    bottom = bottom == height ? y : bottom, top = y;
  }
  if (right < 0) return {};
  return {left, bottom, right - left + 1, top - bottom + 1};
}

}  // namespace gaussdrift::render

template <>
std::vector<gaussdrift::render::FilmKind>& gaussdrift::base::catalogue<gaussdrift::render::FilmKind>();
