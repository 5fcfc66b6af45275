#include "reproduce/published.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>

#include "gaussdrift/error.hpp"

namespace gaussdrift::reproduce {

namespace {

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> cells;
  for (;;) {
    const std::size_t comma = line.find(',');
    cells.emplace_back(line.substr(0, comma));
    if (comma == std::string_view::npos) return cells;
    line.remove_prefix(comma + 1);
  }
}

}  // namespace

PublishedTable::PublishedTable(const std::string& name) : name_(name) {
  const auto& files = published_files();
  const auto file = std::find_if(files.begin(), files.end(), [&](const auto& f) { return f.name == name + ".csv"; });
  if (file == files.end()) throw Error(ExitCode::internal, "there is no published table " + name);
  std::string_view rest = file->bytes;
  while (!rest.empty()) {
    const std::size_t end = rest.find('\n');
    std::vector<std::string> cells = split(rest.substr(0, end));
    rest.remove_prefix(end == std::string_view::npos ? rest.size() : end + 1);
    if (columns_.empty()) {
      columns_ = std::move(cells);
    } else if (cells.size() == columns_.size()) {
      cells_.push_back(std::move(cells));
    } else {
      throw Error(ExitCode::internal, fmt::format("published table {}: row {} has {} cells, its header {}", name,
                                                  cells_.size() + 1, cells.size(), columns_.size()));
    }
  }
}

const std::string& PublishedTable::text(std::size_t row, const std::string& column) const {
  const auto found = std::find(columns_.begin(), columns_.end(), column);
  if (found == columns_.end() || row >= rows())
    throw Error(ExitCode::internal, fmt::format("published table {} has no column {} or row {}", name_, column, row));
  return cells_[row][static_cast<std::size_t>(found - columns_.begin())];
}

std::optional<double> PublishedTable::number(std::size_t row, const std::string& column) const {
  const std::string& cell = text(row, column);
  if (cell.empty()) return {};
  if (cell == "-") return never;
  double value = 0;
  const auto [end, error] = std::from_chars(cell.data(), cell.data() + cell.size(), value);
  if (error != std::errc{} || end != cell.data() + cell.size())
    throw Error(ExitCode::internal, fmt::format("published table {}, {}: \"{}\" is no number", name_, column, cell));
  return value;
}

double PublishedTable::last_digit(std::size_t row, const std::string& column) const {
  const std::string& cell = text(row, column);
  const std::size_t e = std::min(cell.find_first_of("eE"), cell.size()), point = std::min(cell.find('.'), e);
  const auto decimals = static_cast<int>(e - std::min(point + 1, e));
  int exponent = 0;
  if (e < cell.size()) std::from_chars(cell.data() + e + 1, cell.data() + cell.size(), exponent);
  return std::pow(10.0, exponent - decimals);
}

}  // namespace gaussdrift::reproduce
