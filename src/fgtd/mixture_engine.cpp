#include "fgtd/mixture_engine.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <string>

#include "fgtd/arguments.hpp"
#include "fgtd/check.hpp"

namespace fgtd::detail {
namespace {

void check_gaussians(const std::vector<Gaussian>& gaussians, const Options& options, std::size_t dimension) {
  for (std::size_t k = 0; k < gaussians.size(); ++k) {
    check_sigma(gaussians[k].sigma);
    Options of = options;
    of.tolerance = gaussians[k].tolerance;
    check_options(of, dimension);
    if (!std::isfinite(gaussians[k].coefficient))
      throw InvalidArgument("fgtd: the coefficient of Gaussian " + std::to_string(k) + " is " +
                            text(gaussians[k].coefficient) + ", must be finite");
  }
  if (options.hermite)
    throw InvalidArgument("fgtd: parameters of hermite by hand belong to one Gaussian; a Mixture takes none");
}

/// Consecutive Gaussians that are taken together: parts[i] is where the part that ends before i begins. cost(i, j) has the
/// seconds of i .. j - 1 as one part.
template <class Cost>
std::vector<std::size_t> cheapest_parts(std::size_t count, const Cost& cost) {
  std::vector<double> least(count + 1, std::numeric_limits<double>::infinity());
  std::vector<std::size_t> begin(count + 1, 0);
  least[0] = 0;
  for (std::size_t j = 1; j <= count; ++j)
    for (std::size_t i = 0; i < j; ++i)
      if (const double seconds = least[i] + cost(i, j); seconds < least[j]) {
        least[j] = seconds;
        begin[j] = i;
      }
  std::vector<std::size_t> parts;
  for (std::size_t j = count; j > 0; j = begin[j]) parts.push_back(j);
  parts.push_back(0);
  std::reverse(parts.begin(), parts.end());
  return parts;
}

}  // namespace

template <int d>
MixtureEngine<d>::MixtureEngine(const Eigen::Ref<const Points<d>>& sources,
                                const Eigen::Ref<const Eigen::MatrixXd>& weights, std::vector<Gaussian> gaussians,
                                const Options& options)
    : gaussians_(std::move(gaussians)),
      options_(options),
      choices_(gaussians_.size()),
      group_of_(gaussians_.size()),
      sources_(static_cast<std::size_t>(sources.cols())),
      columns_(static_cast<std::size_t>(weights.cols())) {
  check_gaussians(gaussians_, options, d);
  check_points("source", sources.data(), d, sources_, stride<d>(sources), options.threads);
  check_weights(weights, sources_, options.threads);
  check_memory("the plan", 8.0 * static_cast<double>(sources_ * (d + columns_)), options.memory_limit);
  const Buffer<double> position = by_axis<d>(sources.data(), sources_, stride<d>(sources), options.threads);

  std::vector<std::size_t> order(gaussians_.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t a, std::size_t b) { return gaussians_[a].sigma < gaussians_[b].sigma; });
  std::vector<Options> each;
  std::vector<Proposal<d>> alone;
  for (const std::size_t k : order) each.push_back(options_of(k));
  for (std::size_t i = 0; i < order.size(); ++i)
    alone.push_back(choose<d>(position, sources_, columns_, gaussians_[order[i]].sigma, each[i]));
  const bool together = options.method == Method::automatic && sources_ > 0;
  const Situation<d> at = look_at<d>(position, sources_, columns_, 1, options_);
  const auto members = [&](std::size_t i, std::size_t j) {
    return std::vector<std::size_t>(order.begin() + static_cast<std::ptrdiff_t>(i),
                                    order.begin() + static_cast<std::ptrdiff_t>(j));
  };
  const std::vector<std::size_t> parts = cheapest_parts(order.size(), [&](std::size_t i, std::size_t j) {
    if (j == i + 1) return alone[i].choice.seconds;
    if (!together) return std::numeric_limits<double>::infinity();
    std::vector<Gaussian> some;
    for (const std::size_t k : members(i, j)) some.push_back(gaussians_[k]);
    return shared_seconds<d>(at, some);
  });
  for (std::size_t p = 0; p + 1 < parts.size(); ++p) {
    if (parts[p + 1] > parts[p] + 1 && make_shared(at, members(parts[p], parts[p + 1]))) continue;
    for (std::size_t i = parts[p]; i < parts[p + 1]; ++i) make_alone(order[i], std::move(alone[i]), position);
  }
  Choice all;
  for (const Choice& choice : choices_) {
    all.seconds += choice.seconds;
    all.method = choice.method;
  }
  check_seconds(all, options.most_seconds);
  set_weights(weights);
}

template <int d>
Options MixtureEngine<d>::options_of(std::size_t gaussian) const {
  Options of = options_;
  of.tolerance = gaussians_[gaussian].tolerance;
  return of;
}

template <int d>
void MixtureEngine<d>::make_alone(std::size_t gaussian, Proposal<d> proposal, const Buffer<double>& position) {
  check_memory("the plan", proposal.plan_bytes, options_.memory_limit);
  choices_[gaussian] = proposal.choice;
  group_of_[gaussian] = groups_.size();
  Group& group = groups_.emplace_back();
  group.members = {gaussian};
  group.alone = proposal.make(position);
  group.alone->count(choices_[gaussian]);
}

template <int d>
bool MixtureEngine<d>::make_shared(const Situation<d>& at, const std::vector<std::size_t>& members) {
  std::vector<Gaussian> gaussians;
  for (const std::size_t k : members) gaussians.push_back(gaussians_[k]);
  std::optional<SharedProposal<d>> proposal = propose_shared<d>(at, gaussians);
  if (!proposal || proposal->plan_bytes > static_cast<double>(options_.memory_limit)) return false;
  for (std::size_t i = 0; i < members.size(); ++i) {
    choices_[members[i]] = proposal->choices[i];
    group_of_[members[i]] = groups_.size();
  }
  Group& group = groups_.emplace_back();
  group.members = members;
  group.lattice = std::make_unique<SpreadSum<d>>(std::move(proposal->parts), std::move(proposal->layout), at.position,
                                                 options_.threads);
  return true;
}

template <int d>
double MixtureEngine<d>::plan_bytes(std::size_t columns) const {
  double bytes = 0;
  for (const Group& group : groups_) bytes += group.sum().plan_bytes(columns);
  return bytes;
}

template <int d>
void MixtureEngine<d>::set_weights(const Eigen::Ref<const Eigen::MatrixXd>& weights) {
  check_weights(weights, sources_, options_.threads);
  columns_ = static_cast<std::size_t>(weights.cols());
  const bool gaps = columns_ > 1 && weights.outerStride() != weights.rows();
  check_memory("the plan", plan_bytes(columns_) + (gaps ? 8.0 * static_cast<double>(sources_ * columns_) : 0.0),
               options_.memory_limit);
  const Eigen::MatrixXd packed = gaps ? Eigen::MatrixXd(weights) : Eigen::MatrixXd();
  for (Group& group : groups_) group.sum().set_weights(gaps ? packed.data() : weights.data(), columns_);
}

template <int d>
typename MixtureEngine<d>::Requests MixtureEngine<d>::requests_of(
    const Group& group, const std::vector<Combination<d>>& combinations) const {
  Requests requests;
  for (const std::size_t k : group.members) {
    std::vector<Combination<d>> scaled = combinations;
    for (Combination<d>& combination : scaled)
      for (Term<d>& term : combination) term.coefficient *= gaussians_[k].coefficient;
    requests.push_back(make_request<d>(scaled, gaussians_[k].sigma, options_.derivative_order));
  }
  return requests;
}

template <int d>
template <class Bytes, class Evaluate>
Eigen::MatrixXd MixtureEngine<d>::add_groups(std::size_t rows, const std::vector<Combination<d>>& combinations,
                                             const Bytes& bytes, const Evaluate& evaluate) const {
  const std::size_t outputs = combinations.size() * columns_;
  std::vector<Requests> requests;
  double most = 0;
  for (const Group& group : groups_) {
    requests.push_back(requests_of(group, combinations));
    most = std::max(most, bytes(group.sum(), requests.back()[0]));
  }
  check_memory("evaluation",
               plan_bytes(columns_) + most +
                   (groups_.size() > 1 ? 16.0 : 8.0) * static_cast<double>(rows) * static_cast<double>(outputs),
               options_.memory_limit);
  Eigen::MatrixXd values = make_result(rows, outputs), more;
  if (groups_.empty()) values.setZero();
  for (std::size_t g = 0; g < groups_.size(); ++g) {
    if (g == 1) more = make_result(rows, outputs);
    evaluate(groups_[g], requests[g], g == 0 ? values.data() : more.data());
    if (g > 0) values += more;
  }
  return values;
}

template <int d>
Eigen::MatrixXd MixtureEngine<d>::evaluate(const Eigen::Ref<const Points<d>>& targets,
                                           const std::vector<Combination<d>>& combinations) const {
  const std::size_t count = static_cast<std::size_t>(targets.cols());
  check_points("target", targets.data(), d, count, stride<d>(targets), options_.threads);
  const bool gaps = stride<d>(targets) != d;
  const Points<d> packed = gaps ? Points<d>(targets) : Points<d>();
  const double* const at = gaps ? packed.data() : targets.data();
  return add_groups(
      count, combinations,
      [&](const Summation<d>& sum, const Request<d>& request) { return sum.point_bytes(request, count); },
      [&](const Group& group, const Requests& requests, double* values) {
        if (group.alone) {
          group.alone->evaluate(requests[0], at, count, values);
        } else {
          group.lattice->evaluate(requests, at, count, values);
        }
      });
}

template <int d>
Eigen::MatrixXd MixtureEngine<d>::evaluate(const TensorGrid& grid,
                                           const std::vector<Combination<d>>& combinations) const {
  check_grid("grid", grid, d);
  return add_groups(
      grid.size(), combinations,
      [&](const Summation<d>& sum, const Request<d>& request) { return sum.grid_bytes(request, grid); },
      [&](const Group& group, const Requests& requests, double* values) {
        if (group.alone) {
          group.alone->evaluate(requests[0], grid, values);
        } else {
          group.lattice->evaluate(requests, grid, values);
        }
      });
}

template class MixtureEngine<1>;
template class MixtureEngine<2>;
template class MixtureEngine<3>;
template class MixtureEngine<4>;

}  // namespace fgtd::detail
