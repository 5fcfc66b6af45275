// Initial densities rho_0(x): shapes, expressions, and their sum.
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "expression/expression.hpp"
#include "gaussdrift/points.hpp"

namespace gaussdrift {

/// A density is immutable; `add` is safe to call from several threads.
class InitialDensity {
 public:
  virtual ~InitialDensity() = default;
  /// values[i] += rho_0(x_i). Values that are not finite are passed on; the caller reports them with their place.
  virtual void add(const PointsView& x, double* values) const = 0;
  /// The rough cost of a value, in values of a formula with a sine or two.
  virtual double cost() const { return 1; }
  /// One line for people: formula, smoothness, and the mass where it is known.
  virtual std::string describe() const = 0;
  /// The integral over all space; nothing where no closed form is known.
  virtual std::optional<double> mass() const { return std::nullopt; }
};

/// height * profile(s), s = |x - center| / radius, in 2D and 3D.
class RadialDensity : public InitialDensity {
 public:
  enum class Profile {
    wendland,     // (1-s)^4_+ (4s+1), twice continuously differentiable [Sch06, 5.3.2], [Wen95]
    wendland4,    // (1-s)^6_+ (35 s^2 + 18 s + 3) / 3, four times
    wendland6,    // (1-s)^8_+ (32 s^3 + 25 s^2 + 8 s + 1), six times
    cone,         // (1-s)_+, continuous
    gaussian,     // exp(-s^2), smooth
    cosine_bell,  // (1 + cos(pi s)) / 2 for s < 1, else 0; once
    disk          // 1 for s < 1, else 0; discontinuous. In 3D a ball
  };
  RadialDensity(Profile profile, int dimension, const Vector& center, double radius, double height)
      : profile_(profile), dimension_(dimension), center_(center), radius_(radius), height_(height) {}
  void add(const PointsView& x, double* values) const override;
  std::string describe() const override;
  std::optional<double> mass() const override;

 private:
  Profile profile_;
  int dimension_;
  Vector center_;
  double radius_, height_;
};

/// Zalesak's disk: `height` for |x - center| < radius but outside the slot |x - c_x| < slot_width / 2,
/// y - c_y < slot_length - radius, which opens downwards. In 3D a ball, and the slot runs through along z.
class SlottedDisk : public InitialDensity {
 public:
  /// The inner end of the slot must lie inside the disk, as fits() says.
  SlottedDisk(int dimension, const Vector& center, double radius, double slot_width, double slot_length, double height)
      : dimension_(dimension),
        center_(center),
        radius_(radius),
        slot_width_(slot_width),
        slot_length_(slot_length),
        height_(height) {}
  /// Do the corners at the inner end of the slot lie inside the disk?
  static bool fits(double radius, double slot_width, double slot_length);
  void add(const PointsView& x, double* values) const override;
  std::string describe() const override;
  std::optional<double> mass() const override;

 private:
  int dimension_;
  Vector center_;
  double radius_, slot_width_, slot_length_, height_;
};

/// `height` where |x_k - c_k| < lengths_k / 2 for every axis k, else 0.
class BoxDensity : public InitialDensity {
 public:
  BoxDensity(int dimension, const Vector& center, const Vector& lengths, double height)
      : dimension_(dimension), center_(center), lengths_(lengths), height_(height) {}
  void add(const PointsView& x, double* values) const override;
  std::string describe() const override;
  std::optional<double> mass() const override;

 private:
  int dimension_;
  Vector center_, lengths_;
  double height_;
};

/// An expression in x, y, (z) and the params.
class WrittenDensity : public InitialDensity {
 public:
  /// Throws ExpressionError.
  WrittenDensity(const std::string& text, int dimension, const std::vector<std::pair<std::string, double>>& params);
  void add(const PointsView& x, double* values) const override;
  double cost() const override;
  std::string describe() const override;

 private:
  Expression expression_;
};

class SumDensity : public InitialDensity {
 public:
  explicit SumDensity(std::vector<std::unique_ptr<InitialDensity>> parts) : parts_(std::move(parts)) {}
  void add(const PointsView& x, double* values) const override;
  double cost() const override;
  std::string describe() const override;
  std::optional<double> mass() const override;

 private:
  std::vector<std::unique_ptr<InitialDensity>> parts_;
};

}  // namespace gaussdrift
