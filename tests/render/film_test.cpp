// Films are read back by the rules of their formats: what frames they show, and for how long.
#include "render/film.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <limits>
#include <numeric>
#include <vector>

#include "gaussdrift/error.hpp"
#include "render/film_frames.hpp"
#include "render/film_reader.hpp"
#include "render/png.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::render {
namespace {

namespace fs = std::filesystem;

/// Whole numbers that look as if they had no order.
class Noise {
 public:
  std::uint32_t next(std::uint32_t below) {
    state_ = state_ * 6364136223846793005u + 1442695040888963407u;
    return static_cast<std::uint32_t>(state_ >> 33) % below;
  }

 private:
  std::uint64_t state_ = 1;
};

/// Of `colours` colours, which change in a part of the picture alone. The third is like the second.
std::vector<Image> noisy_frames(int width, int height, std::uint32_t colours, std::size_t count) {
  Noise noise;
  std::vector<Image> frames;
  const auto colour = [&] {
    const auto n = noise.next(colours);
    return Colour{static_cast<std::uint8_t>(n), static_cast<std::uint8_t>(7 * n), static_cast<std::uint8_t>(255 - n)};
  };
  for (std::size_t i = 0; i < count; ++i) {
    Image frame = i == 0 ? blank_image(width, height, false) : frames.back();
    for (int y = i == 0 ? 0 : height / 3; i != 2 && y < (i == 0 ? height : 2 * height / 3); ++y)
      for (int x = i == 0 ? 0 : width / 4; x < (i == 0 ? width : width / 2); ++x)
        frame.pixels[static_cast<std::size_t>(y * width + x)] = colour();
    frames.push_back(std::move(frame));
  }
  return frames;
}

Reel reel_of(const std::vector<Image>& frames, double seconds) {
  const auto get = [&frames](std::size_t i) { return frames.at(i); };
  return {frames.front().width, frames.front().height, frames.size(), seconds, get, get};
}

std::string film_of(std::string_view kind, const Reel& reel) {
  const ScratchFolder folder;
  write_film(find_film_kind(kind), reel, folder / "film");
  EXPECT_EQ(folder.count(), 1u) << "whole, and nothing beside it";
  return read_file(folder / "film");
}

/// Rows of images begin below, those of films above.
void expect_frames(const ReadFilm& film, const std::vector<Image>& frames) {
  ASSERT_EQ(film.frames.size(), frames.size());
  for (std::size_t i = 0; i < frames.size(); ++i)
    for (int y = 0; y < film.height; ++y)
      for (int x = 0; x < film.width; ++x)
        ASSERT_EQ(film.frames[i][static_cast<std::size_t>(y * film.width + x)], frames[i].at(x, film.height - 1 - y))
            << "frame " << i << " at " << x << ", " << y;
}

TEST(Film, ShowsEveryPixelOfEveryFrame) {
  // The codes of the larger one fill their table of 4096 several times.
  for (const auto& [width, height] : {std::pair{7, 5}, {160, 120}}) {
    const auto frames = noisy_frames(width, height, 200, 5);
    for (const auto& [kind, read] : {std::pair{"gif", &read_gif}, {"apng", &read_apng}}) {
      const ReadFilm film = read(film_of(kind, reel_of(frames, 1.3)));
      EXPECT_EQ(film.width, width) << kind;
      EXPECT_EQ(film.height, height) << kind;
      EXPECT_TRUE(film.for_ever) << kind;
      expect_frames(film, frames);
      // 1.3 s in five parts of whole hundredths, which add up.
      ASSERT_EQ(film.seconds.size(), 5u);
      EXPECT_NEAR(std::accumulate(film.seconds.begin(), film.seconds.end(), 0.), 1.3, 1e-9) << kind;
      for (const double seconds : film.seconds) EXPECT_NEAR(seconds, 0.26, 0.0101) << kind;
    }
  }
}

TEST(Film, InFewColoursIsNearToOneInMany) {
  // 64 x 64 x 4 shades: more than a GIF has.
  Image many = blank_image(128, 128, false);
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x)
      many.pixels[static_cast<std::size_t>(y * 128 + x)] = {
          static_cast<std::uint8_t>(2 * x), static_cast<std::uint8_t>(2 * y), static_cast<std::uint8_t>(64 * (x % 4))};
  const ReadFilm film = read_gif(film_of("gif", reel_of({many, many}, 1)));
  double squares = 0;
  for (int y = 0; y < 128; ++y)
    for (int x = 0; x < 128; ++x)
      for (std::size_t k = 0; k < 3; ++k) {
        const double apart = film.frames[0][static_cast<std::size_t>(y * 128 + x)][k] - many.at(x, 127 - y)[k];
        squares += apart * apart;
      }
  // Boxes of the best 255 that fill the cube evenly have sides of 40, and 40 / sqrt(12) is 12.
  EXPECT_LT(std::sqrt(squares / (3 * 128 * 128)), 18);
}

TEST(Film, IsTheSameWheneverItIsMade) {
  const auto frames = noisy_frames(40, 30, 900, 6);
  for (const char* kind : {"gif", "apng"})
    EXPECT_EQ(film_of(kind, reel_of(frames, 1)), film_of(kind, reel_of(frames, 1)));
}

TEST(Film, LeavesAnOlderFileWhereItCannotBeMade) {
  const ScratchFolder folder;
  std::ofstream(folder / "film") << "old";
  const auto frames = noisy_frames(16, 16, 9, 3);
  Reel reel = reel_of(frames, 1);
  reel.frame = [](std::size_t i) -> Image {
    if (i == 2) throw FileError("frame 2 is gone");
    return blank_image(16, 16, false);
  };
  for (const FilmKind& kind : film_kinds()) {
    if (!kind.missing().empty()) continue;
    EXPECT_THROW(write_film(kind, reel, folder / "film"), FileError) << kind.about.name;
    EXPECT_EQ(read_file(folder / "film"), "old") << kind.about.name;
    EXPECT_EQ(folder.count(), 1u) << kind.about.name;
  }
}

TEST(Png, ShowsWhatIsNotOpaqueWithoutTheWhiteUnderIt) {
  Image image = blank_image(3, 2, true);
  put_colours(image, 0, 0, 1, 1, {Colour{10, 20, 30}});
  put_mask(image, 1, 0, {0, 0, 1, 1, {128}}, {200, 0, 100});
  const std::string file = png_of(image);
  const std::size_t at = file.find("IDAT");
  const std::string rows = unfiltered(file.substr(at + 4, file.size() - at - 4 - 4 - 12), 3, 2, 4);
  const auto pixel = [&](int row, int column, int k) {
    return static_cast<int>(static_cast<unsigned char>(rows[static_cast<std::size_t>((row * 3 + column) * 4 + k)]));
  };
  for (const auto& [k, value] : {std::pair{0, 10}, {1, 20}, {2, 30}, {3, 255}}) EXPECT_EQ(pixel(1, 0, k), value);
  for (const auto& [k, value] : {std::pair{0, 200}, {1, 0}, {2, 100}})
    EXPECT_NEAR(pixel(1, 1, k), value, 2);  // rounding twice
  EXPECT_EQ(pixel(1, 1, 3), 128);
  EXPECT_EQ(pixel(0, 2, 3), 0);
}

TEST(Strip, CoversAsMuchOfAPixelAsItIsWide) {
  // From x = 1.25 to 3.5, y = 1 to 1.75, and once more over itself.
  Image image = blank_image(5, 3, true);
  StripPainter painter;
  const Point a{1.25, 1}, b{3.5, 1}, c{1.25, 1.75}, d{3.5, 1.75};
  painter.put(image, {{c, d, c}, {a, b, a}, {0, 0, 0}});
  const auto opacity = [&](int x, int y) { return image.opacity[static_cast<std::size_t>(y * 5 + x)]; };
  EXPECT_NEAR(opacity(1, 1), 255 * 0.75 * 0.75, 1);  // rounding
  EXPECT_NEAR(opacity(2, 1), 255 * 0.75, 1);
  EXPECT_NEAR(opacity(3, 1), 255 * 0.75 * 0.5, 1);
  for (const auto& [x, y] : {std::pair{0, 1}, {4, 1}, {2, 0}, {2, 2}}) EXPECT_EQ(opacity(x, y), 0);
  EXPECT_NEAR(image.at(2, 1)[0], 255 * 0.25, 1);
  // What lies beyond the picture does no harm.
  painter.put(image, {{{-9, -9}, {20, 30}}, {{-9, -8}, {20, 31}}, ink});
}

TEST(FilmFrame, KeepsThreeDigitsInFewBytes) {
  FilmFrame frame{1.5, {.lattice = make_lattice(2, {-1, -1, 0}, {1, 1, 0}, 60), .rho = {}}};
  for (std::size_t i = 0; i < frame.density.lattice.size(); ++i)
    frame.density.rho.push_back(std::exp(-1e-2 * static_cast<double>(i)) - (i % 7 == 0 ? 0.2 : 0));
  frame.density.rho[5] = std::numeric_limits<double>::quiet_NaN();
  frame.density.fields = {{"velocity", 2, std::vector<double>(2 * frame.density.rho.size(), -3.25)}};
  const std::string bytes = bytes_of(frame);
  EXPECT_LT(bytes.size(), 3 * frame.density.rho.size());
  const FilmFrame read = film_frame_of(bytes);
  EXPECT_EQ(read.time, 1.5);
  EXPECT_EQ(read.density.lattice.points, frame.density.lattice.points);
  EXPECT_TRUE(std::isnan(read.density.rho[5]));
  for (std::size_t i = 6; i < frame.density.rho.size(); ++i)
    // Half of the last of 12 bits, or nothing below a millionth of a millionth of the largest.
    EXPECT_NEAR(read.density.rho[i], frame.density.rho[i], 1.3e-4 * std::abs(frame.density.rho[i]) + 1e-12);
  EXPECT_EQ(read.density.fields.front().values, frame.density.fields.front().values);
  for (const std::size_t i : {std::size_t{3}, bytes.size() / 2, bytes.size() - 1}) {
    std::string damaged = bytes;
    damaged[i] = static_cast<char>(damaged[i] + 1);
    EXPECT_THROW(film_frame_of(damaged), std::out_of_range) << i;
  }
  EXPECT_THROW(film_frame_of("short"), std::out_of_range);
}

}  // namespace
}  // namespace gaussdrift::render
