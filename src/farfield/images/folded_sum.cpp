#include "farfield/images/folded_sum.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "farfield/check.hpp"

namespace farfield::detail {
namespace {

/// The part of the tolerance that the rest may cost.
constexpr double rest_share = 0.125;

template <int d>
Points<d> points_in_box(const Options& options, const Eigen::Ref<const Points<d>>& points,
                        std::vector<unsigned char>* mirrored) {
  Points<d> inside(d, points.cols());
  if (mirrored) mirrored->assign(static_cast<std::size_t>(points.cols()), 0);
  for (Eigen::Index j = 0; j < points.cols(); ++j)
    for (Eigen::Index l = 0; l < d; ++l) {
      const InBox place = in_box(options.axes[static_cast<std::size_t>(l)], points(l, j));
      inside(l, j) = place.x;
      if (mirrored && place.sign < 0) (*mirrored)[static_cast<std::size_t>(j)] |= static_cast<unsigned char>(1U << l);
    }
  return inside;
}

template <int d>
Points<d> images_of(const Points<d>& sources, const Copies<d>& copies) {
  const Eigen::Index count = sources.cols();
  Points<d> images(d, count * static_cast<Eigen::Index>(copies.near().size()));
  images.leftCols(count) = sources;
  for (std::size_t c = 1; c < copies.near().size(); ++c) {
    const Copy& copy = copies.near()[c];
    for (Eigen::Index l = 0; l < d; ++l) {
      const auto axis = static_cast<std::size_t>(l);
      const double turned = copy.sign[axis] < 0 ? 2 * copies.axes()[axis].centre : 0;
      images.row(l).segment(static_cast<Eigen::Index>(c) * count, count) =
          (copy.sign[axis] * sources.row(l)).array() + (turned + copy.shift[axis]);
    }
  }
  return images;
}

}  // namespace

template <int d>
FoldedSum<d>::FoldedSum(Kernel kernel, const Eigen::Ref<const Points<d>>& sources,
                        const Eigen::Ref<const Points<d>>* targets, const Options& options)
    : kernel_(kernel), options_(options) {
  check_options(kernel, options, d);
  const auto check = [&](const char* kind, const Eigen::Ref<const Points<d>>& points) {
    check_points(kind, points.data(), d, static_cast<std::size_t>(points.cols()),
                 static_cast<std::size_t>(points.outerStride()), options.threads);
  };
  check("source", sources);
  if (targets) check("target", *targets);
  sources_ = points_in_box<d>(options, sources, nullptr);
  targets_ = points_in_box<d>(options, targets ? *targets : sources, &mirrored_);

  double low[3], high[3];
  for (Eigen::Index l = 0; l < d; ++l) {
    low[l] = HUGE_VAL, high[l] = -HUGE_VAL;
    for (const Points<d>* points : {&sources_, &targets_})
      if (points->cols() > 0) {
        low[l] = std::min(low[l], points->row(l).minCoeff());
        high[l] = std::max(high[l], points->row(l).maxCoeff());
      }
    if (!(low[l] <= high[l])) low[l] = high[l] = 0;
  }
  choose_copies(low, high);
  const double count = static_cast<double>(copies_->near().size());
  check_memory("the copies of the sources beyond the faces",
               8.0 * count * (d + 1) * static_cast<double>(sources_.cols()) +
                   8.0 * d * static_cast<double>(sources_.cols() + targets_.cols()),
               options.memory_limit);
  Options near = options;
  near.axes = {};
  near.tolerance = (rest_ ? 1 - rest_share : 1.0) * options.tolerance;
  const Points<d> images = images_of<d>(sources_, *copies_);
  const Eigen::Ref<const Points<d>> all(images), some(targets_);
  near_ = std::make_unique<Engine<d>>(kernel, all, &some, near);
  choice_ = near_->choice();
  choice_.tolerance = options.tolerance;
  choice_.sources = static_cast<std::size_t>(sources_.cols());
  choice_.copies = copies_->near().size();
  if (!rest_) return;
  choice_.rest_degree = rest_->shape().degree();
  choice_.bound += rest_->shape().error();
}

template <int d>
void FoldedSum<d>::choose_copies(const double* low, const double* high) {
  // The smallest tolerances would take too many degrees.
  for (const double distance : {good_distance, 2 * good_distance}) {
    copies_.emplace(options_, low, high, distance);
    if (!copies_->repeats()) return;
    try {
      rest_.emplace(*copies_, RestShape<d>::get(*copies_, rest_share * options_.tolerance));
      return;
    } catch (const ToleranceError&) {
      if (distance > good_distance) throw;
    }
  }
}

template <int d>
Values<d> FoldedSum<d>::evaluate(const Eigen::Ref<const Eigen::VectorXd>& charges, Seconds& seconds) const {
  const Eigen::Index count = sources_.cols();
  check_charges(charges, static_cast<std::size_t>(count));
  Eigen::VectorXd all(count * static_cast<Eigen::Index>(copies_->near().size()));
  for (std::size_t c = 0; c < copies_->near().size(); ++c)
    all.segment(static_cast<Eigen::Index>(c) * count, count) = copies_->near()[c].charge * charges;
  Values<d> values = near_->evaluate(all, seconds);

  Laps laps;
  const Eigen::Index targets = targets_.cols();
  const bool blob = kernel_ == Kernel::vortex_blob;
  if (rest_) {
    Eigen::VectorXd potential = Eigen::VectorXd::Zero(values.potential.size());
    Points<d> field = Points<d>::Zero(d, targets);
    rest_->add(sources_, charges, targets_, options_.threads, potential.size() > 0 ? &potential : nullptr, field);
    values.potential += kernel_ == Kernel::log ? Eigen::VectorXd(-potential) : potential;
    if (blob) {
      values.field.row(0) -= field.row(1) / (2 * std::numbers::pi);
      values.field.row(1) += field.row(0) / (2 * std::numbers::pi);
    } else {
      values.field += field;
    }
  }
  // Beyond a mirror potential and field are the images of those in the box.
  for (Eigen::Index i = 0; i < targets; ++i) {
    const unsigned bits = mirrored_[static_cast<std::size_t>(i)];
    if (bits == 0) continue;
    double turn = 1, sign[3];
    for (int l = 0; l < d; ++l) turn *= sign[l] = bits >> l & 1U ? -1 : 1;
    const double even = options_.mirror_images == MirrorImages::opposite ? turn : 1;
    if (values.potential.size() > 0) values.potential[i] *= even;
    for (Eigen::Index l = 0; l < d; ++l) values.field(l, i) *= even * sign[l] * (blob ? turn : 1);
  }
  const auto check = [&](const char* what, const double* numbers, std::size_t a_target) {
    check_values(what, numbers, static_cast<std::size_t>(targets), a_target, nullptr);
  };
  if (values.potential.size() > 0) check("potential", values.potential.data(), 1);
  check("field", values.field.data(), d);
  seconds.forward += laps.lap();
  return values;
}

template class FoldedSum<2>;
template class FoldedSum<3>;

}  // namespace farfield::detail
