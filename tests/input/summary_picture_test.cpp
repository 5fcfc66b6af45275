// summary.png from the frames that a page plays: which part is shown, and in which colours.
#include <gtest/gtest.h>

#include <cmath>
#include <fstream>

#include "render/picture.hpp"
#include "render/read_png.hpp"
#include "report/reel.hpp"
#include "report/summary_picture.hpp"
#include "scratch_folder.hpp"

namespace gaussdrift::report {
namespace {

/// A blob of height 1 at (0.5, 0) that goes to (0.3, 0), and one of height `other` at (-0.5, 0); on [-1, 1]^2, or on a
/// slab of it in space.
void write_reel(const ScratchFolder& folder, double other, std::size_t layers = 1) {
  const Lattice lattice{
      .dimension = layers > 1 ? 3 : 2, .points = {81, 81, layers}, .origin = {-1, -1, 0}, .spacing = 0.025};
  Reel reel(1'000'000);
  for (std::uint64_t output = 0; output < 3; ++output) {
    std::vector<double> values;
    for (std::size_t z = 0; z < layers; ++z)
      for (std::size_t y = 0; y < 81; ++y)
        for (std::size_t x = 0; x < 81; ++x) {
          const auto blob = [&](double centre) {
            const double dx = lattice.coordinate(0, x) - centre, dy = lattice.coordinate(1, y);
            return std::exp(-100 * (dx * dx + dy * dy));
          };
          values.push_back(blob(0.5 - 0.1 * static_cast<double>(output)) + other * blob(-0.5));
        }
    ReelFrame frame{output, 0.5 * static_cast<double>(output), "", {}};
    frame.streams.push_back(reel.on_grid("rho", lattice, values));
    reel.add(std::move(frame));
  }
  std::ofstream(folder / reel_file, std::ios::binary) << reel.text();
}

const json summary{{"label", "vorticity"}, {"frames", json::array({json::object()})}};

class SummaryPicture : public testing::Test {
 protected:
  void SetUp() override {
    if (const std::string why = render::unavailable_reason(); !why.empty()) GTEST_SKIP() << why;
  }
  /// Of all pixels.
  double part_of_white(const ScratchFolder& folder) {
    const render::Image picture = render::read_png(folder / summary_picture);
    std::size_t count = 0;
    for (const render::Colour& pixel : picture.pixels) count += pixel[0] > 240 && pixel[1] > 240 && pixel[2] > 240;
    return static_cast<double>(count) / static_cast<double>(picture.pixels.size());
  }
};

TEST_F(SummaryPicture, ShowsWhereSomethingIs) {
  const ScratchFolder folder;
  write_reel(folder, 0);
  ReportFiles result;
  // exp(-100 r^2) = 0.01 at r = 0.2146: the points from 0.1 to 0.7 and from -0.2 to 0.2, with a margin of an eighth.
  EXPECT_EQ(draw_summary(folder.path(), summary, result),
            "The pictures show the part of the domain where something is: x from 0 to 0.8, y from -0.275 to 0.275.");
  EXPECT_EQ(result.written.size(), 1u);
  EXPECT_TRUE(result.failed.empty());
  ASSERT_EQ(result.left_out.size(), 1u);
  EXPECT_NE(result.left_out[0].find("compared with nothing"), std::string::npos);
}

TEST_F(SummaryPicture, OfASignedDensityHasWhiteAtZero) {
  const ScratchFolder plain, lopsided;
  ReportFiles result;
  write_reel(plain, 1);
  draw_summary(plain.path(), summary, result);
  write_reel(lopsided, -1);
  draw_summary(lopsided.path(), summary, result);
  EXPECT_GT(part_of_white(lopsided), part_of_white(plain) + 0.1);  // the ground of three of the four panels
}

TEST_F(SummaryPicture, IsDrawnInSpace) {
  const ScratchFolder folder;
  write_reel(folder, 0, 9);
  ReportFiles result;
  draw_summary(folder.path(), summary, result);
  EXPECT_EQ(result.written.size(), 1u);
  EXPECT_TRUE(result.failed.empty());
}

}  // namespace
}  // namespace gaussdrift::report
