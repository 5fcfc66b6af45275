#include "field/velocity/sum_field.hpp"

#include <algorithm>

namespace gaussdrift {

void SumField::add(double t, const PointsView& x, const VectorsView& u) const {
  for (const auto& field : fields_) field->add(t, x, u);
}

void SumField::add_divergence(double t, const PointsView& x, double* values) const {
  for (const auto& field : fields_) field->add_divergence(t, x, values);
}

void SumField::add_gradient(double t, const PointsView& x, const GradientsView& gradients) const {
  for (const auto& field : fields_) field->add_gradient(t, x, gradients);
}

bool SumField::is_steady() const {
  return std::all_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->is_steady(); });
}

bool SumField::is_smooth() const {
  return std::all_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->is_smooth(); });
}

double SumField::held_until(double t) const {
  double until = std::numeric_limits<double>::infinity();
  for (const auto& field : fields_) until = std::min(until, field->held_until(t));
  return until;
}

double SumField::held_since(double t) const {
  double since = -std::numeric_limits<double>::infinity();
  for (const auto& field : fields_) since = std::max(since, field->held_since(t));
  return since;
}

double SumField::cost() const {
  double sum = 0;
  for (const auto& field : fields_) sum += field->cost();
  return sum;
}

bool SumField::is_fitted() const {
  return std::any_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->is_fitted(); });
}

double SumField::fit_error(const PointsView& near) const {
  double sum = 0;
  for (const auto& field : fields_) sum += field->fit_error(near);
  return sum;
}

std::string SumField::why_not_finite(double t, const Vector& x) const {
  for (const auto& field : fields_)
    if (std::string reason = field->why_not_finite(t, x); !reason.empty()) return reason;
  return "";
}

std::optional<Vector> SumField::flow(double from, double to, const Vector& x) const {
  return fields_.size() == 1 ? fields_.front()->flow(from, to, x) : std::nullopt;
}

bool SumField::is_solenoidal() const {
  return std::all_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->is_solenoidal(); });
}

bool SumField::evaluates_in_blocks() const {
  return std::all_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->evaluates_in_blocks(); });
}

std::string SumField::describe() const {
  std::string text;
  for (const auto& field : fields_) text += (text.empty() ? "" : " + ") + field->describe();
  return text.empty() ? "u = 0" : text;
}

}  // namespace gaussdrift
