// Large numbers for people: "12 345 678".
#pragma once

#include <cstddef>
#include <string>

namespace gaussdrift::accuracy {

inline std::string grouped(std::size_t number) {
  std::string digits = std::to_string(number), text;
  for (std::size_t i = 0; i < digits.size(); ++i) {
    if (i > 0 && (digits.size() - i) % 3 == 0) text += ' ';
    text += digits[i];
  }
  return text;
}

}  // namespace gaussdrift::accuracy
