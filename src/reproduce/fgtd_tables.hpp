// The tables of reproduce_fgtd(), one function for those that are measured together. Every row and column says where
// the published numbers are printed; reproduce_fgtd() adds them.
#pragma once

#include <string>
#include <vector>

#include "reproduce/fgtd.hpp"

namespace gaussdrift::reproduce {

/// 1.1e-8, 1e28: a power of ten without needless signs and zeros.
std::string short_power(double value, int digits);

std::vector<Table> analytic_tables();                                // 3.2, 3.3
std::vector<Table> parameter_tables();                               // 3.4, 3.5
std::vector<Table> point_number_tables(const FgtdOptions& options);  // 4.1, 4.2
std::vector<Table> preparation_table(const FgtdOptions& options);    // 4.3
std::vector<Table> break_even_table(const FgtdOptions& options);     // 4.4
std::vector<Table> dimension_table(const FgtdOptions& options);      // 4.5
std::vector<Table> width_table(const FgtdOptions& options);          // 4.6
std::vector<Table> spacing_table(const FgtdOptions& options);        // 4.7
std::vector<Table> point_set_table(const FgtdOptions& options);      // 4.8
std::vector<Table> level_table(const FgtdOptions& options);          // 4.9
std::vector<Table> field_table(const FgtdOptions& options);          // 6.1
std::vector<Table> divergence_table(const FgtdOptions& options);     // 6.2

}  // namespace gaussdrift::reproduce
