// What a word of a case file means: symbols of the thesis, tables, named formulas, functions and values.
#include "input/explain.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "farfield/farfield.hpp"
#include "input/registry.hpp"
#include "input/thesis_symbols.hpp"

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

// Tables A.1 to A.4, as the thesis writes them.
TEST(Explain, AnswersEverySymbolOfTheThesissTables) {
  const std::vector<std::pair<const char*, std::vector<const char*>>> tables = {
      {"A.1",
       {"A",   "A_β", "B_I", "B_i", "c",   "d", "HI", "hi",         "LO",  "lo", "M", "m", "N",   "N_i", "n", "n_c",
        "n_d", "nn",  "p",   "Q",   "Q_I", "R", "r",  "\\tilde{r}", "x_j", "y",  "α", "β", "λ_j", "ν",   "σ"}},
      {"A.2", {"bf", "be_a", "be_n", "e_a", "e_r", "fgtd", "fgtd_prepare", "fgtd_eval", "G"}},
      {"A.3",
       {"c", "h", "j", "n_g", "n_{ge}", "t", "X(t)", "x_j", "u", "u_0", "\\alpha_j(t)", "ϵ", "ζ", "ζ_ϵ", "ρ", "ρ_0",
        "ρ_ϵ^h", "Ω"}},
      {"A.4", {"G", "M", "N", "S", "u", "x_j", "y", "Γ_j", "ω"}}};
  std::size_t symbols = 0;
  for (const auto& [table, all] : tables)
    for (const char* symbol : all) {
      const std::string told = to_text(explain(symbol));
      EXPECT_NE(told.find(std::string("[Sch06, Table ") + table + "]"), std::string::npos) << symbol << ":\n" << told;
      ++symbols;
    }
  EXPECT_EQ(symbols, thesis_symbols().size());
}

// What is said to stand for a symbol is there.
TEST(Explain, SendsSymbolsOfTheThesisToKeysThatThereAre) {
  for (const ThesisSymbol& symbol : thesis_symbols()) {
    EXPECT_FALSE(symbol.here.empty()) << symbol.symbol;
    std::string_view rest = symbol.here;
    for (std::size_t at = rest.find('`'); at != std::string_view::npos; at = rest.find('`')) {
      rest.remove_prefix(at + 1);
      const std::string_view word = rest.substr(0, rest.find('`'));
      rest.remove_prefix(word.size() + 1);
      const bool is_key = word.find('.') != std::string_view::npos && word.find(' ') == std::string_view::npos;
      if (is_key) {
        EXPECT_FALSE(explain(word).empty()) << word;
      }
    }
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

TEST(Explain, TellsTheMethodsOfSumsOverPairs) {
  for (const farfield::Method method : farfield::methods()) {
    if (method == farfield::Method::automatic) continue;
    const std::string told = to_text(explain(to_string(method)));
    EXPECT_NE(told.find("gaussdrift sum --method " + to_string(method) + "\n  " + meaning(method)), std::string::npos)
        << told;
  }
}

TEST(Explain, TellsTheMethodOfRadialSums) {
  const std::string told = to_text(explain("gaussians"));
  EXPECT_NE(told.find("gaussdrift sum --method gaussians\n  replaces the kernel by few Gaussians"), std::string::npos)
      << told;
  EXPECT_NE(told.find("radial kernels, such as the multiquadric"), std::string::npos) << told;
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

std::vector<std::string> lines_of(const std::string& text) {
  std::istringstream in(text);
  std::vector<std::string> lines;
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  return lines;
}

std::string without_breaks(const std::string& text) {
  std::istringstream in(text);
  std::string joined;
  for (std::string word; in >> word;) joined += word + " ";
  return joined;
}

TEST(Explain, BreaksLinesAtTheWidthAndGoesOnBelowTheText) {
  for (const std::size_t columns : {60, 80}) {
    const std::string told = to_text(explain("velocity"), columns), all = overview_text(columns);
    for (const std::string& text : {told, all})
      for (const std::string& line : lines_of(text)) EXPECT_LE(line.size(), columns) << line;
    EXPECT_EQ(without_breaks(told), without_breaks(to_text(explain("velocity"))));
    EXPECT_EQ(without_breaks(all), without_breaks(overview_text()));
    const std::vector<std::string> lines = lines_of(told);
    const auto file =
        std::find_if(lines.begin(), lines.end(), [](const auto& line) { return line.starts_with("  file "); });
    ASSERT_LT(file, lines.end() - 1);
    EXPECT_EQ((file + 1)->find_first_not_of(' '), file->find("a file of ParaView")) << *(file + 1);
  }
  EXPECT_EQ(to_text(explain("velocity"), 20), to_text(explain("velocity"))) << "no room beside the labels";
}

TEST(Explain, BeginsAllMeaningsOfATableInOneColumnApartFromTheSymbols) {
  const std::vector<std::string> lines = lines_of(overview_text());
  for (const Table& table : tables()) {
    std::set<std::size_t> columns;
    auto line = std::find_if(lines.begin(), lines.end(),
                             [&](const auto& one) { return one.starts_with("[" + table.name + "]"); });
    ASSERT_LT(line, lines.end()) << table.name;
    for (const Key& key : keys()) {
      if (key.table != table.name || !key.value.empty()) continue;
      ASSERT_LT(++line, lines.end());
      const std::size_t meaning = line->find("  " + std::string(first_sentence(key.meaning)));
      EXPECT_NE(meaning, std::string::npos) << *line;
      columns.insert(meaning);
      if (!key.symbol.empty()) {
        EXPECT_NE(line->find("  " + std::string(key.symbol) + "  "), std::string::npos) << *line;
      }
    }
    EXPECT_LE(columns.size(), 1u) << table.name;
  }
}

}  // namespace
}  // namespace gaussdrift::input
