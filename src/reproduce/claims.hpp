// What the thesis claims in its text, outside its tables: the choice of parameters [Sch06, 3.7.6, 3.8.1, 3.8.2] and the
// accuracy of the rotating cone [Sch06, 5.3.5], computed beside the print. Says why, where a claim does not hold.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace gaussdrift::reproduce {

struct Claim {
  std::string section;  // "5.3.5"
  std::string name;     // one word or two, the same in the test
  std::string what;     // what is claimed and computed
  std::string printed;  // as it stands there
  double computed = 0;
  std::optional<bool> holds;  // none: seconds of another machine
  std::string note;           // why it does not hold, or what else it needs
};

struct ClaimsReproduction {
  std::vector<Claim> claims;
  double seconds = 0;
};

struct ClaimsOptions {
  int points_an_axis = 0;  // of the density that is compared pair by pair; 0: as printed, 200
  int threads = 1;
};

ClaimsReproduction reproduce_claims(const ClaimsOptions& options,
                                    const std::function<void(const std::string&)>& progress = {});

std::string to_text(const ClaimsReproduction& result);
std::string to_json(const ClaimsReproduction& result);

}  // namespace gaussdrift::reproduce
