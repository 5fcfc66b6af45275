#include "field/named/named_fields.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <cmath>
#include <stdexcept>
#include <string>

namespace gaussdrift {

// Each in a file of its name.
namespace named {
NamedField abc();
NamedField burgers();
NamedField deformation();
NamedField doswell();
NamedField double_gyre();
NamedField lamb_oseen();
NamedField rotation();
NamedField shear();
NamedField sphere_rotation();
NamedField strain();
NamedField swirl();
NamedField taylor_green();
NamedField translation();
}  // namespace named

const std::vector<NamedField>& named_fields() { return base::catalogue<NamedField>(); }

const NamedField& find_named_field(std::string_view name) {
  for (const NamedField& field : named_fields())
    if (field.about.name == name) return field;
  throw std::out_of_range("no velocity field is named " + std::string(name));
}

std::unique_ptr<VelocityField> make_named_field(std::string_view name, const Box& domain, const Arguments& given) {
  const NamedField& field = find_named_field(name);
  const Arguments arguments = complete(field.about, given, domain);
  auto made = field.make(domain.dimension, arguments);
  std::vector<std::string> parts;
  for (const auto& [parameter, values] : arguments)
    if (std::isfinite(values[0]))
      parts.push_back(values.size() == 1 ? fmt::format("{} = {}", parameter, values[0])
                                         : fmt::format("{} = ({})", parameter, fmt::join(values, ", ")));
  made->set_description(fmt::format("{} ({}), div u = {}", name, fmt::join(parts, ", "), field.divergence));
  return made;
}

}  // namespace gaussdrift

namespace gaussdrift::base {

template <>
std::vector<NamedField>& catalogue() {
  static std::vector<NamedField> all = {
      named::rotation(),    named::translation(),  named::shear(),           named::strain(),     named::swirl(),
      named::double_gyre(), named::taylor_green(), named::doswell(),         named::lamb_oseen(), named::deformation(),
      named::abc(),         named::burgers(),      named::sphere_rotation(),
  };
  return all;
}

}  // namespace gaussdrift::base
