#include "field/velocity/velocity.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>

namespace gaussdrift {

namespace {

// Points an expression sees at once: its arrays stay in the first-level cache.
constexpr std::size_t block_length = 512;

/// Calls visit(first, arguments, length) for blocks of points; the arguments are x, y, (z,) t.
template <class Visit>
void for_blocks(double t, const PointsView& x, const Visit& visit) {
  std::array<double, block_length> times;
  times.fill(t);
  for (std::size_t first = 0; first < x.count; first += block_length) {
    const std::size_t length = std::min(block_length, x.count - first);
    std::array<const double*, max_dimension + 1> arguments{};
    for (int k = 0; k < x.dimension; ++k) arguments[k] = x.axis[k] + first;
    arguments[x.dimension] = times.data();
    visit(first, arguments.data(), length);
  }
}

void add_block(const double* part, std::size_t length, double* sum) {
  for (std::size_t i = 0; i < length; ++i) sum[i] += part[i];
}

}  // namespace

ExpressionField::ExpressionField(const std::vector<std::string>& components,
                                 const std::vector<std::pair<std::string, double>>& params) {
  std::vector<std::string> variables{"x", "y"};
  if (components.size() == 3) variables.push_back("z");
  variables.push_back("t");
  for (const auto& text : components) components_.emplace_back(text, variables, params);
}

void ExpressionField::add(double t, const PointsView& x, const VectorsView& u) const {
  std::array<double, block_length> values;
  for_blocks(t, x, [&](std::size_t first, const double* const* arguments, std::size_t length) {
    for (int k = 0; k < x.dimension; ++k) {
      components_[k].evaluate(arguments, length, values.data());
      add_block(values.data(), length, u.axis[k] + first);
    }
  });
}

void ExpressionField::add_divergence(double t, const PointsView& x, double* values) const {
  std::array<double, block_length> slope;
  for_blocks(t, x, [&](std::size_t first, const double* const* arguments, std::size_t length) {
    for (int k = 0; k < x.dimension; ++k) {
      double* const slopes[] = {slope.data()};
      components_[k].differentiate(arguments, length, {static_cast<std::size_t>(k)}, nullptr, slopes);
      add_block(slope.data(), length, values + first);
    }
  });
}

bool ExpressionField::is_steady() const {
  return std::none_of(components_.begin(), components_.end(), [](const Expression& part) { return part.uses("t"); });
}

bool ExpressionField::is_smooth() const {
  return std::all_of(components_.begin(), components_.end(),
                     [](const Expression& part) { return part.rough_spots().empty(); });
}

double ExpressionField::cost() const {
  double sum = 0;
  for (const Expression& part : components_) sum += part.cost();
  return std::max(1.0, sum);
}

bool ExpressionField::is_solenoidal() const {
  constexpr std::array coordinates{"x", "y", "z"};
  for (std::size_t k = 0; k < components_.size(); ++k)
    if (components_[k].uses(coordinates[k])) return false;
  return true;
}

std::string ExpressionField::describe() const {
  std::string text = "u = (";
  for (std::size_t k = 0; k < components_.size(); ++k) text += (k ? ", " : "") + components_[k].text();
  return text + ")";
}

StreamfunctionField::StreamfunctionField(const std::string& psi,
                                         const std::vector<std::pair<std::string, double>>& params)
    : psi_(psi, {"x", "y", "t"}, params) {}

void StreamfunctionField::add(double t, const PointsView& x, const VectorsView& u) const {
  std::array<double, block_length> dx, dy;
  for_blocks(t, x, [&](std::size_t first, const double* const* arguments, std::size_t length) {
    double* const slopes[] = {dx.data(), dy.data()};
    psi_.differentiate(arguments, length, {0, 1}, nullptr, slopes);
    for (std::size_t i = 0; i < length; ++i) {
      u.axis[0][first + i] += dy[i];
      u.axis[1][first + i] -= dx[i];
    }
  });
}

void StreamfunctionField::add_divergence(double /*t*/, const PointsView& /*x*/, double* /*values*/) const {}

bool StreamfunctionField::is_steady() const { return !psi_.uses("t"); }

bool StreamfunctionField::is_smooth() const { return psi_.rough_spots().empty(); }

double StreamfunctionField::cost() const { return std::max(1.0, 3 * psi_.cost()); }  // with two derivatives

std::string StreamfunctionField::describe() const {
  return fmt::format("u = (d psi/dy, -d psi/dx), psi = {}, div u = 0", psi_.text());
}

void SumField::add(double t, const PointsView& x, const VectorsView& u) const {
  for (const auto& field : fields_) field->add(t, x, u);
}

void SumField::add_divergence(double t, const PointsView& x, double* values) const {
  for (const auto& field : fields_) field->add_divergence(t, x, values);
}

bool SumField::is_steady() const {
  return std::all_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->is_steady(); });
}

bool SumField::is_smooth() const {
  return std::all_of(fields_.begin(), fields_.end(), [](const auto& field) { return field->is_smooth(); });
}

double SumField::cost() const {
  double sum = 0;
  for (const auto& field : fields_) sum += field->cost();
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
