#include "field/named_fields.hpp"

#include <stdexcept>
#include <string>

namespace gaussdrift {

const std::vector<NamedField>& named_fields() {
  static const std::vector<NamedField> list = {
      named::rotation(),
  };
  return list;
}

const NamedField& find_named_field(std::string_view name) {
  for (const NamedField& field : named_fields())
    if (field.about.name == name) return field;
  throw std::out_of_range("no velocity field is named " + std::string(name));
}

std::unique_ptr<VelocityField> make_named_field(std::string_view name, const Box& domain, const Arguments& given) {
  const NamedField& field = find_named_field(name);
  return field.make(domain.dimension, complete(field.about, given, domain));
}

}  // namespace gaussdrift
