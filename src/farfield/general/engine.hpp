// The implementation of GeneralPlan: checks the arguments, chooses a method, builds the H2 matrix to a share of the
// tolerance, and measures its error.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "farfield/general/h2_matrix.hpp"

namespace farfield::detail {

template <int d>
class GeneralEngine {
 public:
  /// targets: null if the sources are the targets.
  GeneralEngine(const KernelFunction& kernel, const Eigen::Ref<const Points<d>>& sources,
                const Eigen::Ref<const Points<d>>* targets, const GeneralOptions& options);

  Eigen::VectorXd evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges, GeneralSeconds& seconds) const;
  const GeneralChoice& choice() const { return choice_; }

 private:
  /// All pairs of some targets.
  struct Sample {
    std::vector<std::size_t> targets;
    std::vector<double> charges;  // +1 or -1
    std::vector<double> sums;     // of these charges, at these targets
    std::vector<double> sizes;    // sums of |k| there
    double kernel_size = 0;       // K
  };
  void choose();
  Sample take_sample() const;
  void build(const Sample& sample);
  std::unique_ptr<H2Matrix> make_matrix(double tolerance) const;
  std::vector<LevelTask> tasks_of(const GeneralBlocks& blocks, const GeneralTree& tree, double tolerance) const;
  double measured_error(const H2Matrix& matrix, const Sample& sample) const;
  void tell(const H2Matrix& matrix);

  KernelFunction kernel_;
  GeneralOptions options_;
  GeneralChoice choice_;
  bool self_;
  std::size_t source_count_, target_count_;
  Coordinates source_, target_;       // target_ is empty if self
  std::unique_ptr<H2Matrix> matrix_;  // null: direct
};

}  // namespace farfield::detail
