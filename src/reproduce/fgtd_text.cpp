// The reproduced tables as text and as JSON.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <nlohmann/json.hpp>

#include "reproduce/fgtd.hpp"
#include "reproduce/fgtd_tables.hpp"

namespace gaussdrift::reproduce {

namespace {

// 1e-08 as 1e-8, 1e+28 as 1e28.
std::string short_exponent(std::string text) {
  const std::size_t e = text.find('e');
  if (e == std::string::npos) return text;
  std::size_t digits = e + 2;
  while (digits + 1 < text.size() && text[digits] == '0') ++digits;
  return text.substr(0, e + 1) + (text[e + 1] == '-' ? "-" : "") + text.substr(digits);
}

std::string number(const Column& column, double value, bool published) {
  if (std::isinf(value)) return "-";
  switch (column.quantity) {
    case Quantity::count:
      return fmt::format("{:.0f}", value);
    case Quantity::error:
      if (column.digits > 1 && value >= 1e-2) return fmt::format("{:.6f}", value);
      return short_power(value, column.digits > 1 ? 3 : published ? 1 : 2);
    default:
      if (value >= 100) return fmt::format("{:.0f}", value);
      return short_exponent(fmt::format("{:.{}g}", value, column.digits));
  }
}

// Up to three texts of a cell: then, now, auto.
using Cell = std::vector<std::string>;

Cell cell_of(const Column& column, const Entry& entry) {
  Cell cell;
  if (!column.printed.empty()) cell.push_back(entry.published ? number(column, *entry.published, true) : "");
  cell.push_back(entry.computed ? number(column, *entry.computed, false) : "");
  if (!agrees(column, entry)) cell.back() += "!";
  if (column.automatic) cell.push_back(entry.automatic ? number(column, *entry.automatic, false) : "");
  return cell;
}

Cell heading_of(const Column& column) {
  Cell cell;
  if (!column.printed.empty()) cell.push_back("then");
  cell.push_back(!column.printed.empty() || column.automatic ? "now" : "");
  if (column.automatic) cell.push_back("auto");
  return cell;
}

// "34 arithmetic, 34 order of magnitude": how the numbers of a table are compared.
std::string comparisons_of(const Table& table) {
  std::array<std::size_t, comparisons.size()> counts{};
  for (const Row& row : table.rows)
    for (std::size_t i = 0; i < row.entries.size(); ++i)
      for (std::size_t k = 0; k < comparisons.size(); ++k)
        counts[k] += is_compared(table.columns[i], row.entries[i]) &&
                     comparison_of(table.columns[i], row.entries[i]) == comparisons[k];
  std::string text;
  for (std::size_t k = 0; k < comparisons.size(); ++k)
    if (counts[k] > 0) text += fmt::format("{}{} {}", text.empty() ? "" : ", ", counts[k], to_string(comparisons[k]));
  return text.empty() ? "nothing, because all numbers are seconds" : text;
}

std::string to_text(const Table& table) {
  std::string text = fmt::format("Schroeder 2006, Table {}: {}\n  {}\n  compared: {}\n", table.number, table.title,
                                 table.what, comparisons_of(table));
  std::vector<std::string> lines(table.rows.size() + 2);  // two of headings
  const auto pad = [&] {
    std::size_t widest = 0;
    for (const std::string& line : lines) widest = std::max(widest, line.size());
    for (std::string& line : lines) line.resize(widest, ' ');
  };
  for (std::size_t i = 0; i < table.rows.size(); ++i) lines[i + 2] = table.rows[i].name;
  pad();
  for (std::size_t c = 0; c < table.columns.size(); ++c) {
    const Column& column = table.columns[c];
    std::vector<Cell> cells{heading_of(column)};
    for (const Row& row : table.rows) cells.push_back(cell_of(column, row.entries[c]));
    std::vector<std::string> block(cells.size());
    for (std::size_t part = 0; part < cells[0].size(); ++part) {
      std::size_t widest = 0;
      for (const Cell& cell : cells) widest = std::max(widest, cell[part].size());
      for (std::size_t i = 0; i < cells.size(); ++i)
        block[i] += fmt::format("{}{:>{}}", part > 0 ? " " : "", cells[i][part], widest);
    }
    const std::size_t width = std::max(column.name.size(), block[0].size());
    lines[0] += fmt::format("  | {:<{}}", column.name, width);
    for (std::size_t i = 0; i < block.size(); ++i) lines[i + 1] += fmt::format("  | {:>{}}", block[i], width);
  }
  for (std::size_t i = 0; i < table.rows.size(); ++i)
    if (!table.rows[i].note.empty()) lines[i + 2] += "  | " + table.rows[i].note;
  for (std::string& line : lines) {
    line.erase(line.find_last_not_of(' ') + 1);
    text += line + "\n";
  }
  return text;
}

nlohmann::ordered_json value(const std::optional<double>& number) {
  return number && std::isfinite(*number) ? nlohmann::ordered_json(*number) : nlohmann::ordered_json(nullptr);
}

const char* name(Quantity quantity) {
  constexpr std::array names{"count", "error", "seconds", "factor"};
  return names[static_cast<std::size_t>(quantity)];
}

}  // namespace

std::string short_power(double value, int digits) { return short_exponent(fmt::format("{:.{}e}", value, digits - 1)); }

std::string to_text(const FgtdReproduction& result) {
  std::string text = fmt::format(
      "then  the printed number; seconds of 2006 are those of a Pentium 4 of 3.05 GHz\n"
      "now   method hermite with the thesis's parameters\n"
      "auto  method auto, asked for the error that these parameters gave\n"
      "!     this number does not agree\n"
      "Times are taken on {} thread{}. Seconds are of another machine and not compared.\n"
      "The line \"compared\" counts the numbers of a table by what agreement means:\n"
      "  arithmetic                      a formula gives the same number or power of ten; nothing is measured\n"
      "  equal digits                    all printed digits are the same\n"
      "  order of magnitude              the error lies between a third of the printed power of ten and {} times its "
      "end\n"
      "  at most the published error     the error is at most {} times the end of the printed power of ten\n\n",
      result.threads, result.threads == 1 ? "" : "s", error_slack, error_slack);
  for (const Table& table : result.tables) text += to_text(table) + "\n";
  text += fmt::format("{} number{} compared", result.compared, result.compared == 1 ? "" : "s");
  const char* separator = ": ";
  for (std::size_t k = 0; k < comparisons.size(); ++k) {
    if (result.by_kind[k] == 0) continue;
    text += fmt::format("{}{} {}", separator, result.by_kind[k], to_string(comparisons[k]));
    separator = ", ";
  }
  text += fmt::format("; {} disagree; {:.0f} s\n", result.disagreements.size(), result.seconds);
  for (const std::string& line : result.disagreements) text += "disagrees: " + line + "\n";
  if (!result.off.empty())
    text += fmt::format("{} numbers are a power of ten off, for these reasons:\n", result.off.size());
  std::vector<std::string> reasons;
  for (const auto& [place, why] : result.off)
    if (std::find(reasons.begin(), reasons.end(), why) == reasons.end()) reasons.push_back(why);
  for (const std::string& reason : reasons) {
    text += "  " + reason + ":\n";
    for (const auto& [place, why] : result.off)
      if (why == reason) text += "    " + place + "\n";
  }
  return text;
}

std::string to_json(const FgtdReproduction& result) {
  nlohmann::ordered_json tables = nlohmann::ordered_json::array();
  for (const Table& table : result.tables) {
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const Row& row : table.rows) {
      nlohmann::ordered_json numbers = nlohmann::ordered_json::array();
      for (std::size_t i = 0; i < row.entries.size(); ++i) {
        const Entry& entry = row.entries[i];
        const bool told = is_compared(table.columns[i], entry) || !entry.kept;
        numbers.push_back({{"column", table.columns[i].name},
                           {"quantity", name(table.columns[i].quantity)},
                           {"comparison", to_string(comparison_of(table.columns[i], entry))},
                           {"published", value(entry.published)},
                           {"computed", value(entry.computed)},
                           {"automatic", value(entry.automatic)},
                           {"agrees", told ? nlohmann::ordered_json(agrees(table.columns[i], entry)) : nullptr}});
      }
      rows.push_back({{"row", row.name}, {"numbers", numbers}, {"note", row.note}});
    }
    tables.push_back({{"table", table.number}, {"title", table.title}, {"what", table.what}, {"rows", rows}});
  }
  auto kinds = nlohmann::ordered_json::object(), off = nlohmann::ordered_json::array();
  for (std::size_t k = 0; k < comparisons.size(); ++k) kinds[to_string(comparisons[k])] = result.by_kind[k];
  for (const auto& [place, why] : result.off) off.push_back({{"number", place}, {"why", why}});
  const nlohmann::ordered_json document{{"source", result.source},
                                        {"tables", tables},
                                        {"threads", result.threads},
                                        {"compared", result.compared},
                                        {"comparisons", kinds},
                                        {"off_by_a_power_of_ten", off},
                                        {"disagreements", result.disagreements},
                                        {"seconds", result.seconds}};
  return document.dump(2) + "\n";
}

}  // namespace gaussdrift::reproduce
