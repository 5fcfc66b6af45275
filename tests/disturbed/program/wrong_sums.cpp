// The sums of a program whose libraries err: tests/CMakeLists.txt lets the linker call these functions in place of
// Plan::evaluate... wherever the program does. All pairs are summed rightly; the faster methods are off at one target.
#include <farfield/farfield.hpp>
#include <fgtd/fgtd.hpp>

namespace {

using Points = fgtd::Points<2>;
using Combinations = std::vector<fgtd::Combination<2>>;
using Charges = Eigen::Ref<const Eigen::VectorXd>;

}  // namespace

// A member function takes its object as the first argument.
Eigen::MatrixXd gaussians(const fgtd::Plan<2>* plan, const Eigen::Ref<const Points>& targets,
                          const Combinations& wanted) asm("__real_" WRAPPED_GAUSSIANS);
Eigen::MatrixXd wrong_gaussians(const fgtd::Plan<2>* plan, const Eigen::Ref<const Points>& targets,
                                const Combinations& wanted) asm("__wrap_" WRAPPED_GAUSSIANS);
farfield::Values<2> pairs(const farfield::Plan<2>* plan, const Charges& charges,
                          farfield::Seconds* seconds) asm("__real_" WRAPPED_PAIRS);
farfield::Values<2> wrong_pairs(const farfield::Plan<2>* plan, const Charges& charges,
                                farfield::Seconds* seconds) asm("__wrap_" WRAPPED_PAIRS);

Eigen::MatrixXd wrong_gaussians(const fgtd::Plan<2>* plan, const Eigen::Ref<const Points>& targets,
                                const Combinations& wanted) {
  Eigen::MatrixXd values = gaussians(plan, targets, wanted);
  if (plan->choice().method != fgtd::Method::direct) values(values.rows() - 1, 0) *= 1.5;
  return values;
}

farfield::Values<2> wrong_pairs(const farfield::Plan<2>* plan, const Charges& charges, farfield::Seconds* seconds) {
  farfield::Values<2> values = pairs(plan, charges, seconds);
  if (plan->choice().method != farfield::Method::direct) values.field.rightCols(1) *= 1.5;
  return values;
}
