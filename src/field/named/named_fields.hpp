// Velocity fields by name, `field = "..."` of a case file: each in a file of its own in field/named/, with its facts.
#pragma once

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "base/catalogue.hpp"
#include "base/named.hpp"
#include "field/velocity/velocity.hpp"

namespace gaussdrift {

/// A field that describes itself by its name and its parameters.
class NamedVelocityField : public VelocityField {
 public:
  std::string describe() const override { return description_; }
  void set_description(std::string text) { description_ = std::move(text); }

 private:
  std::string description_;
};

struct NamedField {
  NamedFormula about;
  std::string_view divergence;  // formula, for people
  std::string_view exact_flow;  // formula of VelocityField::flow from time s to t, or why there is none
  /// Of cases with longitudes and latitudes, and only of these: x, y and u are in degrees. Its divergence as a flow on the
  /// sphere is 0; `divergence` is what the coordinates have.
  bool on_sphere = false;
  /// From complete arguments.
  std::function<std::unique_ptr<NamedVelocityField>(int dimension, const Arguments& arguments)> make = {};
};

/// In the order of docs/cases.md.
const std::vector<NamedField>& named_fields();

/// Throws std::out_of_range for an unknown name.
const NamedField& find_named_field(std::string_view name);

/// The field in the domain, with defaults for what is not given. Throws as find_named_field and complete do.
std::unique_ptr<VelocityField> make_named_field(std::string_view name, const Box& domain, const Arguments& given = {});

}  // namespace gaussdrift

namespace gaussdrift::base {
template <>
std::vector<NamedField>& catalogue();
}
