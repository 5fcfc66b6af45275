// The implementation of Plan: checks the arguments, turns every kernel into one of three interactions in units of the
// points' extent, has a method chosen, and gives the results their signs and units.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include "farfield/evaluator.hpp"
#include "farfield/problem.hpp"
#include "farfield/ranks/channel.hpp"

namespace farfield::detail {

template <int d>
class Engine : public Evaluator<d> {
 public:
  /// targets: null if the sources are the targets.
  Engine(Kernel kernel, const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Points<d>>* targets,
         const Options& options);
  /// The points of this rank; the sources are the targets.
  Engine(Kernel kernel, const Eigen::Ref<const Points<d>>& points, std::span<const std::int64_t> numbers,
         const Options& options, Ranks& ranks);
  Engine(const Engine&) = delete;
  Engine& operator=(const Engine&) = delete;

  Values<d> evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges, Seconds& seconds) const override;
  const Choice& choice() const override { return choice_; }
  Received received() const override { return received_; }

 private:
  void set_problem(Kernel kernel, int exponent);
  /// Numbers of targets become those that the caller has given them.
  void check_results(const char* what, const double* values, std::size_t count, std::size_t numbers_a_target) const;
  template <class Work>
  void together(const Work& work) const;

  Options options_;
  Choice choice_;
  int exponent_ = 0;  // of the unit of length, a power of 2
  Problem problem_;
  std::optional<Channel> channel_;                 // on several ranks
  std::vector<std::int64_t> numbers_;              // of the points of this rank
  std::size_t own_sources_ = 0, own_targets_ = 0;  // of this rank
  Received received_;
  std::unique_ptr<Summation> summation_;
};

}  // namespace farfield::detail
