// What a word of a case file means: symbols of the thesis, tables, named formulas, functions and values.
#include "input/explain.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

#include "input/registry.hpp"

namespace gaussdrift::input {
namespace {

TEST(Explain, KnowsTheSymbolsOfTheThesis) {
  const std::vector<std::pair<const char*, const char*>> symbols = {{"n_ge", "evaluate.per_axis"},
                                                                    {"c", "particles.overlap"},
                                                                    {"tau", "time.step"},
                                                                    {"τ", "time.step"},
                                                                    {"T", "time.end"},
                                                                    {"zeta", "particles.cutoff"},
                                                                    {"rho_0", "density"},
                                                                    {"eps", "eps = c h"},
                                                                    {"ε", "eps = c h"},
                                                                    {"h", "(n_g - 1)"},
                                                                    {"sigma", "1 / eps^2"},
                                                                    {"alpha_j", "h^d rho_0(x_j)"},
                                                                    {"X_j", "u(X_j, t)"},
                                                                    {"u", "velocity.u"}};
  for (const auto& [symbol, part] : symbols) {
    const std::string told = to_text(explain(symbol));
    EXPECT_NE(told.find(part), std::string::npos) << symbol << ":\n" << told;
  }
}

TEST(Explain, TellsTablesFieldsShapesFunctionsAndValues) {
  const std::vector<std::pair<const char*, const char*>> words = {
      {"time", "Runge-Kutta method. `rk4` is the classical method"},
      {"[time]", "Runge-Kutta method. `rk4` is the classical method"},
      {"rotation", "exact flow"},
      {"slotted_disk", "width of the slot"},
      {"hypot", "without overflow"},
      {"gauss4", "particles.cutoff"},
      {"slot_width", "shape = \"slotted_disk\""}};
  for (const auto& [word, part] : words) {
    const std::string told = to_text(explain(word));
    EXPECT_NE(told.find(part), std::string::npos) << word << ":\n" << told;
  }
}

TEST(Explain, KnowsEveryKeyTableAndChoice) {
  for (const Key& key : keys()) {
    const std::string full =
        key.table.empty() ? std::string(key.name) : std::string(key.table) + "." + std::string(key.name);
    EXPECT_FALSE(explain(full).empty()) << full;
    EXPECT_FALSE(explain(key.name).empty()) << key.name;
    for (const auto choice : key.choices) EXPECT_FALSE(explain(choice).empty()) << choice;
    if (!key.symbol.empty()) {
      EXPECT_FALSE(explain(key.symbol).empty()) << key.symbol;
    }
  }
  for (const std::string& table : table_names()) EXPECT_FALSE(explain("[" + table + "]").empty()) << table;
  EXPECT_TRUE(explain("overlapp").empty());
  EXPECT_TRUE(explain("").empty());
}

}  // namespace
}  // namespace gaussdrift::input
