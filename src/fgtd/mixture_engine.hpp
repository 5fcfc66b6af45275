// The implementation of Mixture: parts its Gaussians into groups by predicted cost. A group has a lattice of its own, or
// is one Gaussian by any method.
#pragma once

#include <memory>
#include <utility>
#include <vector>

#include "fgtd/choose.hpp"
#include "fgtd/mixture.hpp"
#include "fgtd/spread/shared.hpp"

namespace fgtd::detail {

template <int d>
class MixtureEngine {
 public:
  MixtureEngine(const Eigen::Ref<const Points<d>>& sources, const Eigen::Ref<const Eigen::MatrixXd>& weights,
                std::vector<Gaussian> gaussians, const Options& options);

  Eigen::MatrixXd evaluate(const Eigen::Ref<const Points<d>>& targets,
                           const std::vector<Combination<d>>& combinations) const;
  Eigen::MatrixXd evaluate(const TensorGrid& grid, const std::vector<Combination<d>>& combinations) const;
  void set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights);

  const std::vector<Choice>& choices() const { return choices_; }
  const std::vector<std::size_t>& groups() const { return group_of_; }

 private:
  using Requests = std::vector<Request<d>>;
  struct Group {
    std::vector<std::size_t> members;  // Gaussians, widest first
    std::unique_ptr<Summation<d>> alone;
    std::unique_ptr<SpreadSum<d>> lattice;

    Summation<d>& sum() const { return alone ? *alone : *lattice; }
  };
  /// Options of one Gaussian.
  Options options_of(std::size_t gaussian) const;
  void make_alone(std::size_t gaussian, Proposal<d> proposal, const Buffer<double>& position);
  /// False if no lattice serves all of them.
  bool make_shared(const Situation<d>& at, const std::vector<std::size_t>& members);
  double plan_bytes(std::size_t columns) const;
  Requests requests_of(const Group& group, const std::vector<Combination<d>>& combinations) const;
  /// `bytes(group, request)` and `evaluate(group, requests, values)` for all groups, which add up.
  template <class Bytes, class Evaluate>
  Eigen::MatrixXd add_groups(std::size_t rows, const std::vector<Combination<d>>& combinations, const Bytes& bytes,
                             const Evaluate& evaluate) const;

  std::vector<Gaussian> gaussians_;
  Options options_;
  std::vector<Choice> choices_;
  std::vector<std::size_t> group_of_;
  std::vector<Group> groups_;
  std::size_t sources_ = 0, columns_ = 0;
};

}  // namespace fgtd::detail
