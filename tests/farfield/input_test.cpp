// Wrong arguments are refused with a sentence that names the argument, its value and the rule.
#include <gtest/gtest.h>

#include <functional>
#include <limits>

#include "farfield/naive.hpp"

namespace {

using farfield::Kernel;
using farfield::Method;

template <class Error>
void expect_refused(const std::function<void()>& work, const std::string& says) {
  try {
    work();
    ADD_FAILURE() << "was taken; expected: " << says;
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find(says), std::string::npos) << error.what();
  }
}

const farfield::Points<3> space = naive::cube<3>(10, 1);
const farfield::Points<2> plane = naive::cube<2>(10, 1);
const farfield::Points<1> line = naive::cube<1>(10, 1);

void plan3(const farfield::Options& options, Kernel kernel = Kernel::coulomb) {
  farfield::Plan<3>(kernel, space, options);
}
void plan2(const farfield::Options& options, Kernel kernel = Kernel::coulomb) {
  farfield::Plan<2>(kernel, plane, options);
}

TEST(FarfieldInput, DefaultsAreValid) { EXPECT_NO_THROW(plan3({})); }

TEST(FarfieldInput, OptionsThatBreakARule) {
  using farfield::InvalidArgument;
  expect_refused<InvalidArgument>([] { plan3({.tolerance = 0}); }, "Options::tolerance = 0, must lie in (0, 1)");
  expect_refused<InvalidArgument>([] { plan3({.tolerance = 1}); }, "Options::tolerance = 1, must lie in (0, 1)");
  expect_refused<InvalidArgument>([] { plan3({.tolerance = std::nan("")}); }, "Options::tolerance = nan");
  expect_refused<InvalidArgument>([] { plan3({.threads = -1}); }, "Options::threads = -1");
  expect_refused<InvalidArgument>([] { plan3({.core_radius = 1}); }, "Options::core_radius = 1, must be 0");
  expect_refused<InvalidArgument>([] { plan2({}, Kernel::vortex_blob); }, "Options::core_radius = 0, must be positive");
  expect_refused<farfield::ToleranceError>([] { plan3({.tolerance = 1e-13, .method = Method::symmetric}); },
                                           "cannot be promised by symmetric, must be at least 1e-11");
}

TEST(FarfieldInput, KernelsThatDoNotExistInADimension) {
  using farfield::InvalidArgument;
  expect_refused<InvalidArgument>([] { farfield::Plan<1>(Kernel::coulomb, line); },
                                  "coulomb exists in 2 and 3 dimensions");
  expect_refused<InvalidArgument>([] { plan3({}, Kernel::log); }, "log exists in 1 and 2 dimensions");
  expect_refused<InvalidArgument>([] { plan3({.core_radius = 1}, Kernel::vortex_blob); },
                                  "vortex-blob exists in 2 dimensions");
}

TEST(FarfieldInput, NumbersThatAreNotFinite) {
  using farfield::InvalidArgument;
  farfield::Points<3> points = space;
  points(1, 7) = std::numeric_limits<double>::infinity();
  expect_refused<InvalidArgument>([&] { farfield::Plan<3>(Kernel::coulomb, points); }, "source 7, coordinate 1 is inf");
  expect_refused<InvalidArgument>([&] { farfield::Plan<3>(Kernel::coulomb, space, points); },
                                  "target 7, coordinate 1 is inf");
  const farfield::Plan<3> plan(Kernel::coulomb, space);
  Eigen::VectorXd charges = Eigen::VectorXd::Ones(10);
  charges[3] = std::nan("");
  expect_refused<InvalidArgument>([&] { (void)plan.evaluate(charges); }, "charge 3 is nan");
  expect_refused<InvalidArgument>([&] { (void)plan.evaluate(charges.head(9)); }, "there are 9 charges for 10 sources");
}

TEST(FarfieldInput, SumsBeyondTheRangeOfDouble) {
  farfield::Points<3> points = space;
  points.col(0).setZero();
  points.col(1) << 1e-200, 0, 0;
  const farfield::Plan<3> plan(Kernel::coulomb, points);
  expect_refused<farfield::RangeError>([&] { (void)plan.evaluate(Eigen::VectorXd::Ones(10)); },
                                       "the field at target 0 exceeds the range");
}

TEST(FarfieldInput, NumbersThatAreNoMethod) {
  expect_refused<farfield::InvalidArgument>([] { plan3({.method = static_cast<Method>(9)}); },
                                            "Options::method = 9 is no method; farfield::methods() lists them");
}

TEST(FarfieldInput, MoreMemoryThanAllowed) {
  const auto many = naive::cube<3>(20000, 1);
  for (const Method method : farfield::methods())
    expect_refused<farfield::MemoryLimitError>(
        [&] { farfield::Plan<3>(Kernel::coulomb, many, {.method = method, .memory_limit = 1 << 18}); },
        "Options::memory_limit allows");
}

}  // namespace
