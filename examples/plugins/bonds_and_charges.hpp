// SPDX-License-Identifier: BSL-1.0
// A sum of two parts for the program, with the kicks of each, and of both, as letters.
// [system]
#include <nysalt/flows/exact_flow.hpp>
#include <nysalt/plugin.hpp>
#include "../systems/bonded_chain.hpp"

/// Four masses with stiff bonds, part 0, and charges, part 1.
struct bonds_and_charges : examples::bonded_chain<4> {
  bonds_and_charges() : sum_of_parts(examples::stiff_bonds<4>(20.0), examples::soft_charges<4>(2.0)) {}
};

NYSALT_SYSTEM(bonds_and_charges, "stiff bonds, and charges of one sign",
              starts([](const bonds_and_charges&, double spread) {
                const Eigen::Vector4d rest = Eigen::Vector4d::Zero();
                return normal_around<4>({rest, rest}, 0.01 * spread, 0.3 * spread);
              }));
// [/system]
