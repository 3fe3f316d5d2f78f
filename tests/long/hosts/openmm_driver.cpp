// SPDX-License-Identifier: BSL-1.0
// Runs statements of an exported integrator in OpenMM's reference platform, in double precision: atoms of
// Lennard and Jones in OpenMM's units, free, or with the distance of atoms 0 and 1 constrained. Reads
//   ATOMS MASS CONSTRAINED STEP STEPS FRICTION KT SEED
//   x y z vx vy vz of each atom
//   statements: METHOD, or METHOD NAME EXPRESSION, one on a line, with tabulators between
// and writes positions and velocities, or with a friction the sums of x^2 and m v^2 of all steps.
#include <OpenMM.h>

#include <cmath>
#include <cstdio>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

int main() {
  int atoms, constrained, steps, seed;
  double mass, step, friction, temperature;
  std::cin >> atoms >> mass >> constrained >> step >> steps >> friction >> temperature >> seed;
  std::vector<OpenMM::Vec3> x, v;
  for (int i = 0; i < atoms; ++i) {
    OpenMM::Vec3 a, b;
    std::cin >> a[0] >> a[1] >> a[2] >> b[0] >> b[1] >> b[2];
    x.push_back(a);
    v.push_back(b);
  }
  OpenMM::System system;
  for (int i = 0; i < atoms; ++i) system.addParticle(mass);
  if (friction > 0) {
    auto* const wells = new OpenMM::CustomExternalForce("0.5*(x^2+y^2+z^2)");
    for (int i = 0; i < atoms; ++i) wells->addParticle(i);
    system.addForce(wells);
  } else {
    auto* const pairs = new OpenMM::NonbondedForce();
    for (int i = 0; i < atoms; ++i) pairs->addParticle(0.0, 1.0, 1.0);
    system.addForce(pairs);
  }
  if (constrained != 0) {
    const OpenMM::Vec3 d = x[0] - x[1];
    system.addConstraint(0, 1, std::sqrt(d.dot(d)));
  }
  OpenMM::CustomIntegrator integrator(step);
  integrator.setConstraintTolerance(1e-12);
  integrator.setRandomNumberSeed(seed);
  if (friction > 0) {
    integrator.addGlobalVariable("friction", friction);
    integrator.addGlobalVariable("kT", temperature);
  }
  std::string line;
  while (std::getline(std::cin, line)) {
    if (line.empty()) continue;
    std::istringstream words(line);
    std::string method, name, expression;
    std::getline(words, method, '\t');
    std::getline(words, name, '\t');
    std::getline(words, expression, '\t');
    if (method == "addPerDofVariable") integrator.addPerDofVariable(name, 0.0);
    if (method == "addComputePerDof") integrator.addComputePerDof(name, expression);
    if (method == "addUpdateContextState") integrator.addUpdateContextState();
    if (method == "addConstrainPositions") integrator.addConstrainPositions();
    if (method == "addConstrainVelocities") integrator.addConstrainVelocities();
  }
  OpenMM::Context context(system, integrator, OpenMM::Platform::getPlatformByName("Reference"));
  context.setPositions(x);
  context.setVelocities(v);
  if (friction > 0) {
    double squares = 0, kinetic = 0;
    for (int k = 0; k < steps; ++k) {
      integrator.step(1);
      const auto state = context.getState(OpenMM::State::Positions | OpenMM::State::Velocities);
      for (const auto& q : state.getPositions()) squares += q.dot(q);
      for (const auto& u : state.getVelocities()) kinetic += mass * u.dot(u);
    }
    std::printf("%.17g %.17g\n", squares / (3.0 * atoms * steps), kinetic / (3.0 * atoms * steps));
    return 0;
  }
  integrator.step(steps);
  const auto state =
      context.getState(OpenMM::State::Positions | OpenMM::State::Velocities | OpenMM::State::Energy);
  for (int i = 0; i < atoms; ++i) {
    const auto& a = state.getPositions()[i];
    const auto& b = state.getVelocities()[i];
    std::printf("%.17g %.17g %.17g %.17g %.17g %.17g\n", a[0], a[1], a[2], b[0], b[1], b[2]);
  }
  std::printf("%.17g\n", state.getPotentialEnergy() + state.getKineticEnergy());
}
