// The frames that a page plays: how wrong they are, how many bytes they take, and what a damaged file does.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "gaussdrift/error.hpp"
#include "report/reel.hpp"

namespace gaussdrift::report {
namespace {

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

/// Three waves along x, two along y, of height 3 around 5.
std::vector<double> waves(std::uint32_t nx, std::uint32_t ny) {
  std::vector<double> values;
  for (std::uint32_t y = 0; y < ny; ++y)
    for (std::uint32_t x = 0; x < nx; ++x) values.push_back(5 + 3 * std::sin(19. * x / nx) * std::cos(13. * y / ny));
  return values;
}

/// Numbers that look like chance, so that they cannot be packed.
std::vector<double> noise(std::size_t count) {
  std::vector<double> values;
  std::uint64_t state = 1;
  for (std::size_t i = 0; i < count; ++i) {
    state = state * 6364136223846793005u + 1442695040888963407u;
    values.push_back(static_cast<double>(state >> 33));
  }
  return values;
}

TEST(Stream, IsWrongByHalfAStepAtMost) {
  for (const double factor : {1., -1e-300, 1e300}) {
    std::vector<double> values = waves(37, 23);
    for (double& value : values) value *= factor;
    const Stream stream = stream_of("rho", 1, {37, 23, 1}, values);
    const std::vector<double> back = values_of(stream);
    ASSERT_EQ(back.size(), values.size());
    const double step = stream.max / levels_between_ends - stream.min / levels_between_ends;
    for (std::size_t i = 0; i < values.size(); ++i)  // 1e-12: of the rounding of the sum itself
      EXPECT_LE(std::abs(back[i] - values[i]), step * (0.5 + 1e-9)) << i;
  }
}

TEST(Stream, KeepsEndsConstantsAndWhatIsNoNumber) {
  const Stream ends = stream_of("a", 1, {2, 1, 1}, {-3, 7});
  EXPECT_EQ(values_of(ends), (std::vector<double>{-3, 7}));
  EXPECT_EQ(values_of(stream_of("a", 1, {3, 1, 1}, {4, 4, 4})), (std::vector<double>{4, 4, 4}));
  const std::vector<double> holes = values_of(stream_of("a", 1, {2, 2, 1}, {nan, 1, 2, INFINITY}));
  EXPECT_TRUE(std::isnan(holes[0]) && std::isnan(holes[3]));
  EXPECT_EQ(holes[1], 1);
  EXPECT_EQ(holes[2], 2);
  const std::vector<double> none = values_of(stream_of("a", 1, {2, 1, 1}, {nan, nan}));
  EXPECT_TRUE(std::isnan(none[0]) && std::isnan(none[1]));
}

TEST(Stream, CoarserHasEverySecondPointAsItWas) {
  const Stream all = stream_of("a", 3, {7, 4, 3}, noise(84)), half = coarser(all);
  EXPECT_EQ(half.shape, (std::array<std::uint32_t, 3>{4, 2, 2}));
  EXPECT_EQ(half.every, 6u);
  const std::vector<double> fine = values_of(all), coarse = values_of(half);
  for (std::size_t z = 0; z < 2; ++z)
    for (std::size_t y = 0; y < 2; ++y)
      for (std::size_t x = 0; x < 4; ++x) EXPECT_EQ(coarse[(z * 2 + y) * 4 + x], fine[(2 * z * 4 + 2 * y) * 7 + 2 * x]);
}

/// A reel of noise on a grid of 40 x 30 points: some 2400 bytes an output.
Reel reel_of(std::size_t most_bytes, std::uint64_t outputs, std::uint64_t first = 0, std::optional<Reel> before = {}) {
  Reel reel = before ? std::move(*before) : Reel(most_bytes);
  const Lattice lattice{.dimension = 2, .points = {40, 30, 1}, .origin = {-1, 2, 0}, .spacing = 0.5};
  for (std::uint64_t output = first; output < outputs; ++output) {
    std::vector<double> values = noise(1200);
    values[0] = static_cast<double>(output);
    ReelFrame frame{output, 0.1 * static_cast<double>(output), "", {}};
    frame.streams.push_back(reel.on_grid("rho", lattice, values));
    reel.add(std::move(frame));
  }
  return reel;
}

TEST(Reel, DropsOutputsFirstAndPointsThen) {
  const Reel all = reel_of(10'000'000, 50);
  EXPECT_EQ(all.frames().size(), 50u);
  EXPECT_EQ(all.every_output(), 1u);
  const Reel some = reel_of(70'000, 50);
  EXPECT_LE(some.bytes(), 70'000u);
  EXPECT_EQ(some.every_output(), 2u);
  EXPECT_EQ(some.every_point(), 1u);
  EXPECT_EQ(some.frames().front().output, 0u);
  EXPECT_EQ(some.frames().back().output, 49u);
  EXPECT_EQ(some.frames().size(), 26u);
  const Reel few = reel_of(10'000, 50);
  EXPECT_LE(few.bytes(), 10'000u);
  EXPECT_EQ(few.every_point(), 2u);
  EXPECT_GT(few.frames().size(), 8u);
  EXPECT_EQ(few.density(few.frames().front(), "rho").lattice.spacing, 1);
}

TEST(Reel, OfARunThatWasStoppedIsThatOfOneThatWasNot) {
  const Reel whole = reel_of(40'000, 60);
  for (const std::uint64_t stopped : {3, 31, 47}) {
    Reel before = reel_of(40'000, stopped), after(40'000);
    base::StateBytes bytes;
    before.pass(bytes);
    const std::string state = bytes.written();
    base::StateBytes read(state);
    after.pass(read);
    read.end();
    EXPECT_EQ(reel_of(40'000, 60, stopped, std::move(after)).text(), whole.text()) << stopped;
  }
}

TEST(Reel, ComesBackFromItsFile) {
  const Reel reel = reel_of(1'000'000, 3);
  const std::string text = reel.text();
  const Reel back = Reel::from_text(text);
  EXPECT_EQ(back.text(), text);
  const DensityGrid grid = back.density(back.frames()[2], "rho");
  EXPECT_EQ(grid.lattice.points, (std::array<std::size_t, 3>{40, 30, 1}));
  EXPECT_EQ(grid.lattice.origin[1], 2);
  EXPECT_EQ(grid.rho.size(), 1200u);
  EXPECT_THROW(back.density(back.frames()[2], "error"), FileError);
}

TEST(Reel, DamagedIsAnError) {
  const std::string text = reel_of(1'000'000, 2).text();
  for (std::size_t length = 0; length < text.size(); length += 97)
    EXPECT_THROW(Reel::from_text(text.substr(0, length)), FileError) << length;
  const auto with = [&](const std::string& old, const std::string& other) {
    std::string changed = text;
    changed.replace(changed.find(old), old.size(), other);
    return changed;
  };
  EXPECT_THROW(Reel::from_text(with("gdreel1", "gdreel2")), FileError);
  EXPECT_THROW(Reel::from_text(with("\"shape\":[40", "\"shape\":[00")), FileError);
  EXPECT_THROW(Reel::from_text(with("\"every_output\":1", "\"every_output\":0")), FileError);
  const Reel longer = Reel::from_text(with("\"shape\":[40", "\"shape\":[41"));
  EXPECT_THROW(longer.density(longer.frames()[0], "rho"), FileError);  // the bytes are those of other numbers
}

}  // namespace
}  // namespace gaussdrift::report
