// [output.pictures] and output.animation: what a case may say, and what it may not.
#include <gtest/gtest.h>

#include "cases.hpp"
#include "input/same_past.hpp"

namespace gaussdrift::input {
namespace {

std::string looks(const std::string& lines) { return errors(cone + "[output.pictures]\n" + lines + "\n"); }

Case animated(const std::string& value) { return parse_case(cone, "cone.toml", {"output.animation=" + value}).spec; }

TEST(Pictures, AreWrittenAsTheyAreRead) {
  const std::string lines =
      "[output.pictures]\nrange = [0.5, 2]\nlog = true\nsize = [800, 600]\ncolour_map = \"grey\"\nview = [30, 40]\n"
      "zoom = [-0.5, 0.5, 0, 1]\ntransparent = true\nlarge_type = true\n";
  const Case spec = parse_case(cone + lines, "cone.toml").spec;
  EXPECT_EQ(spec.output.pictures.size, (std::array{800, 600}));
  const std::string text = gaussdrift::case_text(spec);
  expect_has(text, lines);
  EXPECT_EQ(gaussdrift::case_text(parse_case(text, "again.toml").spec), text);
  EXPECT_EQ(gaussdrift::case_text(parse_case(cone, "cone.toml").spec).find("pictures"), std::string::npos);
}

TEST(Pictures, SayWhatCannotBe) {
  EXPECT_EQ(looks("log = true"), "");
  expect_has(looks("range = [1, 0]"), "output.pictures.range goes from 1 to 0, which is no range");
  expect_has(looks("range = [0, 1]\nlog = true"), "a logarithm needs numbers above 0");
  expect_has(looks("range = [0, 1]\nper_frame = true"), "one range for all pictures, and per_frame wants many");
  expect_has(looks("range = [0, 1, 2]"), "output.pictures.range has 3 numbers; it needs 2");
  expect_has(looks("size = [640, 480.5]"), "480.5 is not a whole number of pixels");
  expect_has(looks("view = [0, 90]"), "it lies between 5 and 85 degrees");
  expect_has(looks("zoom = [0, 9, 0, 1]"), "goes from 0 to 9 along x; the domain has");
  expect_has(looks("zoom = [0, 1]"), "it needs 4: the lower and the upper end along each axis");
  expect_has(looks("colour_map = \"jet\""), "known values: \"viridis\"");
  expect_has(looks("field = \"vorticity\""),
             "output.pictures.field shows the vorticity, which output.fields does not name");
  expect_has(looks("velocity = \"arrows\""), "images = [\"heatmap\"]");
}

TEST(AnimationKey, IsAKindOrTrue) {
  EXPECT_EQ(animated("true").output.animation->kind, "gif");
  EXPECT_FALSE(animated("false").output.animation.has_value());
  EXPECT_EQ(animated("\"webm\"").output.animation->kind, "webm");
  for (const char* value : {"true", "\"apng\""}) {
    const std::string text = gaussdrift::case_text(animated(value));
    EXPECT_EQ(gaussdrift::case_text(parse_case(text, "again.toml").spec), text);
  }
}

TEST(AnimationKey, BelongsToThePastBesideItsKind) {
  const Case none = animated("false"), gif = animated("true"), mp4 = animated("\"mp4\"");
  EXPECT_TRUE(changed_keys(gif, mp4).past.empty());
  EXPECT_EQ(changed_keys(gif, mp4).future, std::vector<std::string>{"output.animation"});
  EXPECT_FALSE(changed_keys(none, gif).past.empty());
  Case more = gif;
  more.output.animation->frames = 7;
  EXPECT_EQ(changed_keys(gif, more).past, std::vector<std::string>{"output.animation_frames"});
}

}  // namespace
}  // namespace gaussdrift::input
