// A plan whose axes have something beyond their ends: points are put into the box, copies of the sources next to it are
// sources for an engine, and the rest of all copies is added to its results.
#pragma once

#include <memory>
#include <optional>
#include <vector>

#include "farfield/engine.hpp"
#include "farfield/images/rest.hpp"

namespace farfield::detail {

template <int d>
class FoldedSum : public Evaluator<d> {
 public:
  /// targets: null if the sources are the targets.
  FoldedSum(Kernel kernel, const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Points<d>>* targets,
            const Options& options);

  Values<d> evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges, Seconds& seconds) const override;
  const Choice& choice() const override { return choice_; }

 private:
  /// For points of this extent.
  void choose_copies(const double* low, const double* high);

  Kernel kernel_;
  Options options_;
  Choice choice_;
  Points<d> sources_, targets_;          // in the box
  std::vector<unsigned char> mirrored_;  // of targets; bit l: along axis l
  std::optional<Copies<d>> copies_;
  std::optional<Rest<d>> rest_;
  std::unique_ptr<Engine<d>> near_;
};

}  // namespace farfield::detail
