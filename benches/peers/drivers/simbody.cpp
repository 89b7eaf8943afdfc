// Simbody (Sherman, Seth and Delp 2011), Debian's package. A setting is INTEGRATOR:ACCURACY, the integrators `merson`, `feldberg` and
// `cpodes` (BDF with Newton's method); `cost` measures set-up, an evaluation and a step.
#include <Simbody.h>

#include <memory>

#include "problem.h"

using SimTK::MobilizedBody;
using SimTK::Rotation;
using SimTK::Transform;
using SimTK::UnitVec3;
using SimTK::Vec3;

static Vec3 vector(const Three &x) { return {x[0], x[1], x[2]}; }

struct Machine {
    SimTK::MultibodySystem system;
    SimTK::SimbodyMatterSubsystem matter{system};
    SimTK::GeneralForceSubsystem forces{system};
    std::vector<SimTK::MobilizedBodyIndex> body;
    SimTK::State state;

    MobilizedBody &of(int k) { return k < 0 ? matter.updGround() : matter.updMobilizedBody(body[size_t(k)]); }

    explicit Machine(const Problem &p) {
        SimTK::Force::UniformGravity(forces, matter, vector(p.gravity));
        for (const Body &b : p.bodies) {
            const Vec3 com = vector(b.com);
            const SimTK::Inertia central(b.inertia[0], b.inertia[1], b.inertia[2]);
            const SimTK::Body::Rigid rigid(SimTK::MassProperties(b.mass, com, central.shiftFromMassCenter(-com, b.mass)));
            const UnitVec3 axis(vector(b.axis));
            const Rotation turn(axis, b.slides ? SimTK::CoordinateAxis(SimTK::XAxis) : SimTK::CoordinateAxis(SimTK::ZAxis));
            const Transform outer(turn, vector(b.at)), inner(turn, Vec3(0));
            MobilizedBody &parent = of(b.parent);
            if (b.slides) body.push_back(MobilizedBody::Slider(parent, outer, rigid, inner).getMobilizedBodyIndex());
            else body.push_back(MobilizedBody::Pin(parent, outer, rigid, inner).getMobilizedBodyIndex());
            MobilizedBody &made = matter.updMobilizedBody(body.back());
            if (b.torque != 0) SimTK::Force::MobilityConstantForce(forces, made, 0, b.torque);
            if (b.damping != 0) SimTK::Force::MobilityLinearDamper(forces, made, 0, b.damping);
        }
        for (const Spring &s : p.springs) {
            MobilizedBody &a = of(s.a), &b = of(s.b);
            SimTK::Force::TwoPointLinearSpring(forces, a, vector(s.at_a), b, vector(s.at_b), s.stiffness, s.length);
            if (s.damping != 0) SimTK::Force::TwoPointLinearDamper(forces, a, vector(s.at_a), b, vector(s.at_b), s.damping);
        }
        for (const Loop &c : p.loops) {
            MobilizedBody &a = of(c.a), &b = of(c.b);
            if (p.plane) {
                for (const auto &normal : {UnitVec3(SimTK::XAxis), UnitVec3(SimTK::YAxis)})
                    SimTK::Constraint::PointInPlane(a, normal, SimTK::dot(normal, vector(c.at_a)), b, vector(c.at_b));
                continue;
            }
            SimTK::Constraint::Ball(a, vector(c.at_a), b, vector(c.at_b));
            const UnitVec3 axis(vector(c.axis));
            const UnitVec3 one = axis.perp(), two(SimTK::cross(axis, one));
            SimTK::Constraint::ConstantAngle(a, axis, b, one);
            SimTK::Constraint::ConstantAngle(a, axis, b, two);
        }
        state = system.realizeTopology();
        system.realizeModel(state);
        for (size_t k = 0; k < p.bodies.size(); ++k) {
            of(int(k)).setOneQ(state, 0, p.bodies[k].q);
            of(int(k)).setOneU(state, 0, p.bodies[k].v);
        }
        system.realize(state, SimTK::Stage::Acceleration);
    }
};

static std::unique_ptr<SimTK::Integrator> integrator(const std::string &name, const SimTK::System &system) {
    if (name == "merson") return std::make_unique<SimTK::RungeKuttaMersonIntegrator>(system);
    if (name == "feldberg") return std::make_unique<SimTK::RungeKuttaFeldbergIntegrator>(system);
    return std::make_unique<SimTK::CPodesIntegrator>(system, SimTK::CPodes::BDF, SimTK::CPodes::Newton);
}

int main(int count, char **words) {
    const Problem problem = read_problem(words[1]);
    for (int k = 2; k < count; ++k) {
        const std::string setting = words[k];
        if (setting == "cost") {
            double begin = now();
            Machine machine(problem);
            const double built = now() - begin;
            double best = 1e9, step = 1e9;
            for (int r = 0; r < 10; ++r) {
                machine.state.updTime() += 0;
                machine.state.updQ() += 0;
                begin = now();
                machine.system.realize(machine.state, SimTK::Stage::Acceleration);
                best = std::min(best, now() - begin);
                if (best > 1) break;
            }
            SimTK::RungeKuttaMersonIntegrator merson(machine.system);
            merson.setAccuracy(1e-3);
            merson.initialize(machine.state);
            begin = now();
            int steps = 0;
            while (steps < 10 && now() - begin < 5) {
                const int before = merson.getNumStepsTaken();
                merson.stepTo(merson.getTime() + 1e-3);
                steps += merson.getNumStepsTaken() - before;
            }
            step = (now() - begin) / std::max(1, steps);
            print_run(setting, built, {best, step});
            continue;
        }
        const size_t colon = setting.find(':');
        std::vector<double> measured;
        double begin = now();
        try {
            Machine machine(problem);
            auto by = integrator(setting.substr(0, colon), machine.system);
            by->setAccuracy(std::stod(setting.substr(colon + 1)));
            by->setProjectEveryStep(true);
            by->setReturnEveryInternalStep(true);
            by->setFinalTime(problem.end);
            begin = now();
            by->initialize(machine.state);
            while (by->getTime() < problem.end && now() - begin < 20) by->stepTo(problem.end);
            if (by->getTime() >= problem.end) {
                const SimTK::State &state = by->getState();
                machine.system.realize(state, SimTK::Stage::Velocity);
                for (const Measure &m : problem.measures) {
                    const MobilizedBody &body = machine.of(m.body);
                    if (m.kind == "point") measured.push_back(body.findStationLocationInGround(state, vector(m.place))[m.coordinate]);
                    else measured.push_back(m.kind == "q" ? body.getOneQ(state, 0) : body.getOneU(state, 0));
                }
            }
        } catch (const std::exception &failure) {
            std::cerr << setting << ": " << std::string(failure.what()).substr(0, 300) << std::endl;
        }
        print_run(setting, now() - begin, measured);
    }
}
