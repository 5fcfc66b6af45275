#include "sim/grid_fields.hpp"

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <utility>

#include "sim/follow/particle_fields.hpp"

namespace gaussdrift {

namespace {

GridFieldKind density() { return {.about = {.name = "rho", .meaning = "the density, which is always there"}}; }

GridFieldKind gradient() {
  return {.about = {.name = "gradient", .meaning = "the gradient of the density", .is_vector = {true, true}},
          .of_density = [](int dimension) {
            std::vector<std::vector<std::array<int, max_dimension>>> components;
            for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
              std::array<int, max_dimension> along{};
              along[k] = 1;
              components.push_back({along});
            }
            return components;
          }};
}

GridFieldKind laplacian() {
  return {.about = {.name = "laplacian", .meaning = "the Laplacian of the density"}, .of_density = [](int dimension) {
            std::vector<std::array<int, max_dimension>> sum;
            for (std::size_t k = 0; k < static_cast<std::size_t>(dimension); ++k) {
              sum.emplace_back();
              sum.back()[k] = 2;
            }
            return std::vector<std::vector<std::array<int, max_dimension>>>{sum};
          }};
}

GridFieldKind velocity() {
  return {.about = {.name = "velocity",
                    .meaning = "the velocity of the flow",
                    .is_vector = {true, true},
                    .is_of_flow = true},
          .of_flow = [](const FlowThere& flow, double* components) {
            std::copy_n(flow.velocity.begin(), flow.dimension, components);
          }};
}

GridFieldKind vorticity() {
  return {.about = {.name = "vorticity",
                    .meaning = "the curl of the velocity; in the plane its component out of it",
                    .is_vector = {false, true},
                    .is_of_flow = true},
          .of_flow =
              [](const FlowThere& flow, double* components) {
                const auto& g = flow.gradient;
                if (flow.dimension == 2)
                  components[0] = g[1][0] - g[0][1];
                else
                  for (std::size_t k = 0; k < 3; ++k)
                    components[k] = g[(k + 2) % 3][(k + 1) % 3] - g[(k + 1) % 3][(k + 2) % 3];
              },
          .needs_gradient = true};
}

GridFieldKind divergence() {
  return {.about = {.name = "divergence", .meaning = "the divergence of the velocity", .is_of_flow = true},
          .of_flow =
              [](const FlowThere& flow, double* components) {
                components[0] = flow.gradient[0][0] + flow.gradient[1][1] + flow.gradient[2][2];
              },
          .needs_gradient = true};
}

// A short piece of fluid in the direction e grows at the rate e . S e, S the symmetric part of the gradient.
GridFieldKind stretch() {
  return {.about = {.name = "stretch",
                    .meaning = "the largest rate at which the flow stretches lengths: the largest eigenvalue of the "
                               "symmetric part of the velocity's gradient",
                    .is_of_flow = true},
          .of_flow =
              [](const FlowThere& flow, double* components) {
                const auto& g = flow.gradient;
                const auto strain = [&](int k, int i) { return (g[k][i] + g[i][k]) / 2; };
                if (flow.dimension == 2) {
                  components[0] = (g[0][0] + g[1][1]) / 2 + std::hypot((g[0][0] - g[1][1]) / 2, strain(0, 1));
                  return;
                }
                Eigen::Matrix3d matrix;
                for (int k = 0; k < 3; ++k)
                  for (int i = 0; i < 3; ++i) matrix(k, i) = strain(k, i);
                // A solver does not end on what is no number.
                components[0] = !matrix.allFinite() ? matrix.sum()
                                                    : matrix.selfadjointView<Eigen::Lower>().eigenvalues().maxCoeff();
              },
          .needs_gradient = true};
}

}  // namespace

const std::vector<GridFieldKind>& grid_fields() { return base::catalogue<GridFieldKind>(); }

const GridFieldKind& find_grid_field(std::string_view name) {
  return base::find_named(grid_fields(), "field of the grid", name);
}

std::vector<const GridFieldKind*> fields_beside_density(const OutputSpec& output) {
  std::vector<const GridFieldKind*> kinds;
  for (const GridField& field : output.fields)
    if (const GridFieldKind& kind = find_grid_field(field.name); kind.of_density || kind.of_flow)
      kinds.push_back(&kind);
  return kinds;
}

}  // namespace gaussdrift

template <>
std::vector<gaussdrift::GridFieldKind>& gaussdrift::base::catalogue<gaussdrift::GridFieldKind>() {
  using namespace gaussdrift;
  static std::vector<GridFieldKind> all = [] {
    std::vector<GridFieldKind> kinds{density(),   gradient(),   laplacian(), velocity(),
                                     vorticity(), divergence(), stretch()};
    for (GridFieldKind& kind : particle_field_kinds()) kinds.push_back(std::move(kind));
    return kinds;
  }();
  return all;
}
