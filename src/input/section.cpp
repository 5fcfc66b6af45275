#include "input/section.hpp"

#include <mutex>
#include <set>

namespace gaussdrift::input {

namespace {

Type type_of(NamedParameter::Kind kind) {
  switch (kind) {
    case NamedParameter::Kind::number:
      return Type::number;
    case NamedParameter::Kind::whole:
      return Type::whole;
    case NamedParameter::Kind::point:
      return Type::point;
    case NamedParameter::Kind::choice:
      return Type::choice;
    case NamedParameter::Kind::expression:
    case NamedParameter::Kind::expression_in_time:
      return Type::expression;
  }
  return Type::number;
}

}  // namespace

Key key_of(const NamedParameter& parameter, std::string_view with, std::string_view value) {
  const auto choices = parameter.choices ? parameter.choices() : std::vector<NamedChoice>{};
  return {.name = parameter.name,
          .type = type_of(parameter.kind),
          .required = parameter.fallback.empty() && !parameter.optional,
          .fallback = parameter.fallback,
          .range = parameter.range,
          .choices = base::names_of(choices),
          .unit = parameter.unit,
          .symbol = parameter.symbol,
          .meaning = with_choices(parameter.meaning, choices),
          .with = with,
          .value = value};
}

std::string_view kept(std::string text) {
  static std::mutex one_at_a_time;
  static std::set<std::string> texts;
  const std::lock_guard lock(one_at_a_time);
  return *texts.insert(std::move(text)).first;
}

}  // namespace gaussdrift::input
