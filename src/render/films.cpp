#include <cerrno>
#include <cmath>
#include <system_error>

#include "render/film.hpp"
#include "write/atomic_file.hpp"

namespace gaussdrift::render {

// Each in a file of its name; both of ffmpeg in film_video.cpp.
FilmKind gif_film();
FilmKind apng_film();
FilmKind mp4_film();
FilmKind webm_film();

}  // namespace gaussdrift::render

template <>
std::vector<gaussdrift::render::FilmKind>& gaussdrift::base::catalogue<gaussdrift::render::FilmKind>() {
  using namespace gaussdrift::render;
  static std::vector<FilmKind> all{gif_film(), apng_film(), mp4_film(), webm_film()};
  return all;
}

namespace gaussdrift::render {

const std::vector<FilmKind>& film_kinds() { return base::catalogue<FilmKind>(); }

const FilmKind& find_film_kind(std::string_view name) { return base::find_named(film_kinds(), "kind of film", name); }

long Reel::begin(std::size_t i, double parts_of_a_second) const {
  return std::lround(parts_of_a_second * seconds * static_cast<double>(i) / static_cast<double>(frames));
}

void put_bytes(std::FILE* file, std::string_view bytes) {
  if (std::fwrite(bytes.data(), 1, bytes.size(), file) != bytes.size())
    throw std::system_error(errno, std::generic_category());
}

void write_film(const FilmKind& kind, const Reel& reel, const std::filesystem::path& file) {
  write::write_atomically(file, [&](std::FILE* stream) { kind.write(reel, stream); });
}

}  // namespace gaussdrift::render
