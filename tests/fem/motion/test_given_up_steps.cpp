#include <gtest/gtest.h>

#include <stdexcept>

#include "dovetail/core/error.hpp"
#include "dovetail/core/parallel.hpp"
#include "dovetail/fem/solve/statics.hpp"
#include "dynamics_helpers.hpp"

namespace dovetail::fem {
namespace {

enum class Fault { none, numerical, foreign, nan, input };

/// Gives up where it is stretched along z by more than a tenth.
class Brittle : public PlainNeoHookean {
public:
  explicit Brittle(Fault fault) : PlainNeoHookean(1e6, 1e6), fault_(fault) {}
  void evaluate(const PointBatch& batch) const override {
    PlainNeoHookean::evaluate(batch);
    for (std::size_t g = 0; g < batch.groups; ++g)
      for (std::size_t l = 0; l < pointLanes; ++l)
        if (batch.F[(9 * g + 8) * pointLanes + l] > 1.1) fail(batch.P[9 * g * pointLanes + l]);
  }

private:
  void fail(double& stress) const {
    if (fault_ == Fault::numerical) throw NumericalError("the return mapping does not settle", "point 3", "");
    if (fault_ == Fault::foreign) throw std::runtime_error("a law of somebody else's");
    if (fault_ == Fault::input) throw InputError("no such state", "law", "stretch it less");
    if (fault_ == Fault::nan) stress = std::nan("");
  }
  Fault fault_;
};

struct Pulled {
  SolidMesh mesh = boxOf(ElementShape::hex8, {2, 2, 40}, {}, {0.1, 0.1, 2.0});
  Model model = makeModel(mesh);

  explicit Pulled(Fault fault) {
    model.add(makeSolid(mesh, std::make_shared<Brittle>(fault)));
    addMass(model);
    model.constraints.hold(nodeSet(mesh, "z-"));
    model.constraints.prescribe(nodeSet(mesh, "z+"), 2, [](double t) { return 0.3 * t; });
  }
};

const char* reason(Fault fault) {
  return fault == Fault::numerical ? "return mapping" : fault == Fault::foreign ? "somebody else" : "not finite";
}

TEST(GivenUpSteps, StaticsCutThemAndKeepTheLastEquilibrium) {
  for (const Fault fault : {Fault::numerical, Fault::foreign, Fault::nan})
    for (const int threadCount : {1, 2}) {
      setThreads(threadCount);
      Pulled p(fault);
      std::vector<Vec3> u;
      double t = 0.0;
      const auto remember = [&](const Model& model, const StaticStep& step) {
        u = model.nodes.u;
        t = step.t;
        return true;
      };
      try {
        solveStatics(p.model, 1.0, {.firstStep = 0.3, .smallestStep = 0.01}, remember);
        ADD_FAILURE() << "it went through";
      } catch (const NumericalError& error) {
        EXPECT_NE(std::string(error.what()).find(reason(fault)), std::string::npos) << error.what();
      }
      EXPECT_GT(t, 0.5);  // a stretch of 1.1 at t = 2/3
      EXPECT_EQ(p.model.t, t);
      EXPECT_EQ(p.model.nodes.u, u);
    }
  setThreads(1);
}

TEST(GivenUpSteps, WrongInputPassesThroughAndLeavesTheModelAsItWas) {
  Pulled p(Fault::input);
  std::vector<Vec3> u;
  EXPECT_THROW(solveStatics(p.model, 1.0, {.firstStep = 0.3},
                            [&](const Model& model, const StaticStep&) {
                              u = model.nodes.u;
                              return true;
                            }),
               InputError);
  EXPECT_GT(p.model.t, 0.2);
  EXPECT_EQ(p.model.nodes.u, u);
}

TEST(GivenUpSteps, ALinearSolverThatStopsIsAReasonToo) {
  Pulled p(Fault::none);
  StaticOptions options{.firstStep = 0.5, .smallestStep = 0.1};
  options.newton.linear = {.method = linalg::LinearMethod::conjugateGradients, .maxIterations = 2};
  try {
    solveStatics(p.model, 1.0, options);
    ADD_FAILURE() << "two iterations are enough";
  } catch (const NumericalError& error) {
    EXPECT_NE(std::string(error.what()).find("conjugate gradients stop"), std::string::npos) << error.what();
  }
  EXPECT_EQ(p.model.t, 0.0);
  EXPECT_EQ(p.model.nodes.u, std::vector<Vec3>(p.model.nodes.u.size()));
}

TEST(GivenUpSteps, ImplicitStepsAreCutAndTheLastOneStays) {
  for (const Fault fault : {Fault::numerical, Fault::foreign, Fault::nan, Fault::input})
    for (const Scheme& scheme : {generalisedAlpha(0.8), energyMomentum()}) {
      Pulled p(fault);
      std::vector<Vec3> u, v;
      ImplicitIntegrator integrator(p.model, 0.012, {.scheme = scheme, .maxCuts = 0});
      double t = 0.0;
      const auto run = [&] {
        for (int k = 0; k < 100; ++k) {
          u = p.model.nodes.u;
          v = p.model.nodes.v;
          t = p.model.t;
          integrator.step();
        }
      };
      if (fault == Fault::input)
        EXPECT_THROW(run(), InputError);
      else
        EXPECT_THROW(run(), NumericalError);
      EXPECT_GT(t, 0.4);
      EXPECT_EQ(p.model.t, t);
      EXPECT_EQ(p.model.nodes.u, u);
      EXPECT_EQ(p.model.nodes.v, v);
    }
}

TEST(GivenUpSteps, PathsKeepTheLastEquilibrium) {
  Pulled p(Fault::foreign);
  std::vector<Vec3> u;
  EXPECT_THROW(followPath(p.model, 1.0, {.firstStep = 0.2},
                          [&](const Model& model, const StaticStep&) {
                            u = model.nodes.u;
                            return true;
                          }),
               NumericalError);
  EXPECT_GT(p.model.t, 0.6);
  EXPECT_LT(p.model.t, 0.68);
  EXPECT_EQ(p.model.nodes.u, u);
}

}  // namespace
}  // namespace dovetail::fem
