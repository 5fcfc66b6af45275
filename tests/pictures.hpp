// Whether the program was built with pictures. The build says so (src/render/CMakeLists.txt), not the program: where it
// was built with them and draws none, tests fail.
#pragma once

#include <gtest/gtest.h>

namespace gaussdrift {

#ifdef GAUSSDRIFT_PICTURES
constexpr bool draws_pictures = true;
#else
constexpr bool draws_pictures = false;
#endif
constexpr const char* without_pictures = "built without pictures: GAUSSDRIFT_OSMESA=OFF, or OSMesa was not found";

/// Tests that look at pictures.
class Drawn : public testing::Test {
 protected:
  void SetUp() override {
    if (!draws_pictures) GTEST_SKIP() << without_pictures;
  }
};

}  // namespace gaussdrift
