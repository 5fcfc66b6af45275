#include "field/density/density.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace gaussdrift {

namespace {

using std::numbers::pi;
using Profile = RadialDensity::Profile;

double profile_value(Profile profile, double s) {
  const double outside = std::max(0.0, 1 - s), square = outside * outside;
  switch (profile) {
    case Profile::wendland:
      return square * square * (4 * s + 1);
    case Profile::wendland4:
      return square * square * square * ((35 * s + 18) * s + 3) / 3;
    case Profile::wendland6:
      return square * square * square * square * (((32 * s + 25) * s + 8) * s + 1);
    case Profile::cone:
      return outside;
    case Profile::gaussian:
      return std::exp(-s * s);
    case Profile::cosine_bell:
      return s < 1 ? 0.5 * (1 + std::cos(pi * s)) : 0;
    case Profile::disk:
      return s < 1 ? 1 : 0;
  }
  return 0;
}

struct ProfileFacts {
  const char* text;     // formula and smoothness
  double plane, solid;  // integral of the profile over the plane and over space, at radius 1
};

ProfileFacts facts(Profile profile) {
  switch (profile) {
    case Profile::wendland:
      return {"wendland (1-s)^4 (4s+1), twice continuously differentiable", pi / 7, 2 * pi / 21};
    case Profile::wendland4:
      return {"wendland4 (1-s)^6 (35s^2+18s+3)/3, 4 times continuously differentiable", pi / 9, 32 * pi / 495};
    case Profile::wendland6:
      return {"wendland6 (1-s)^8 (32s^3+25s^2+8s+1), 6 times continuously differentiable", 7 * pi / 78, 64 * pi / 1365};
    case Profile::cone:
      return {"cone 1-s, continuous", pi / 3, pi / 3};
    case Profile::gaussian:
      return {"gaussian exp(-s^2), smooth", pi, pi * std::sqrt(pi)};
    case Profile::cosine_bell:
      return {"cosine bell (1+cos(pi s))/2, once continuously differentiable", pi * (0.5 - 2 / (pi * pi)),
              2 * pi * (1. / 3 - 2 / (pi * pi))};
    case Profile::disk:
      return {"disk, discontinuous", pi, 4 * pi / 3};
  }
  throw std::logic_error("a density shape without facts");
}

std::string place(const Vector& point, int dimension) {
  std::string text = fmt::format("({:g}, {:g}", point[0], point[1]);
  return text + (dimension == 3 ? fmt::format(", {:g})", point[2]) : ")");
}

std::string with_mass(const std::string& text, const std::optional<double>& mass) {
  return mass ? fmt::format("{}, mass {:.9g}", text, *mass) : text;
}

}  // namespace

void RadialDensity::add(const PointsView& x, double* values) const {
  for (std::size_t i = 0; i < x.count; ++i) {
    double square = 0;
    for (int k = 0; k < x.dimension; ++k) {
      const double distance = (x.axis[k][i] - center_[k]) / radius_;
      square += distance * distance;
    }
    values[i] += height_ * profile_value(profile_, std::sqrt(square));
  }
}

std::string RadialDensity::describe() const {
  return with_mass(fmt::format("{}; centre {}, radius {:g}, height {:g}", facts(profile_).text,
                               place(center_, dimension_), radius_, height_),
                   mass());
}

std::optional<double> RadialDensity::mass() const {
  const ProfileFacts unit = facts(profile_);
  return height_ * (dimension_ == 3 ? unit.solid * radius_ * radius_ * radius_ : unit.plane * radius_ * radius_);
}

bool SlottedDisk::fits(double radius, double slot_width, double slot_length) {
  return slot_width > 0 && slot_length > 0 && std::hypot(slot_width / 2, slot_length - radius) < radius;
}

void SlottedDisk::add(const PointsView& x, double* values) const {
  for (std::size_t i = 0; i < x.count; ++i) {
    const double dx = x.axis[0][i] - center_[0], dy = x.axis[1][i] - center_[1];
    const double dz = x.dimension == 3 ? x.axis[2][i] - center_[2] : 0;
    const bool inside = dx * dx + dy * dy + dz * dz < radius_ * radius_;
    const bool in_slot = std::abs(dx) < slot_width_ / 2 && dy < slot_length_ - radius_;
    values[i] += inside && !in_slot ? height_ : 0;
  }
}

std::string SlottedDisk::describe() const {
  return with_mass(
      fmt::format("slotted disk of Zalesak, discontinuous; centre {}, radius {:g}, slot {:g} wide and {:g} long, "
                  "height {:g}",
                  place(center_, dimension_), radius_, slot_width_, slot_length_, height_),
      mass());
}

// The slot covers int_{-w/2}^{w/2} (top + sqrt(r^2 - x^2)) dx of the disk, top = its inner end above the centre.
std::optional<double> SlottedDisk::mass() const {
  if (dimension_ == 3) return std::nullopt;
  const double half = slot_width_ / 2, top = slot_length_ - radius_;
  const double slot = slot_width_ * top + half * std::sqrt(radius_ * radius_ - half * half) +
                      radius_ * radius_ * std::asin(half / radius_);
  return height_ * (pi * radius_ * radius_ - slot);
}

void BoxDensity::add(const PointsView& x, double* values) const {
  for (std::size_t i = 0; i < x.count; ++i) {
    bool inside = true;
    for (int k = 0; k < x.dimension; ++k) inside = inside && std::abs(x.axis[k][i] - center_[k]) < lengths_[k] / 2;
    values[i] += inside ? height_ : 0;
  }
}

std::string BoxDensity::describe() const {
  return with_mass(fmt::format("box, discontinuous; centre {}, lengths {}, height {:g}", place(center_, dimension_),
                               place(lengths_, dimension_), height_),
                   mass());
}

std::optional<double> BoxDensity::mass() const {
  double volume = height_;
  for (int k = 0; k < dimension_; ++k) volume *= lengths_[k];
  return volume;
}

WrittenDensity::WrittenDensity(const std::string& text, int dimension,
                               const std::vector<std::pair<std::string, double>>& params)
    : expression_(text, dimension == 3 ? std::vector<std::string>{"x", "y", "z"} : std::vector<std::string>{"x", "y"},
                  params) {}

void WrittenDensity::add(const PointsView& x, double* values) const {
  constexpr std::size_t block_length = 512;
  std::array<double, block_length> part;
  for (std::size_t first = 0; first < x.count; first += block_length) {
    const std::size_t length = std::min(block_length, x.count - first);
    expression_.evaluate(x.block(first, length).axis.data(), length, part.data());
    for (std::size_t i = 0; i < length; ++i) values[first + i] += part[i];
  }
}

double WrittenDensity::cost() const { return std::max(1.0, expression_.cost()); }

std::string WrittenDensity::describe() const { return "rho_0 = " + expression_.text(); }

void SumDensity::add(const PointsView& x, double* values) const {
  for (const auto& part : parts_) part->add(x, values);
}

double SumDensity::cost() const {
  double sum = 0;
  for (const auto& part : parts_) sum += part->cost();
  return sum;
}

std::string SumDensity::describe() const {
  std::string text;
  for (const auto& part : parts_) text += (text.empty() ? "" : " + ") + part->describe();
  return text.empty() ? "rho_0 = 0" : text;
}

std::optional<double> SumDensity::mass() const {
  double sum = 0;
  for (const auto& part : parts_) {
    const auto mass = part->mass();
    if (!mass) return std::nullopt;
    sum += *mass;
  }
  return sum;
}

}  // namespace gaussdrift
