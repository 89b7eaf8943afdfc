// Pinocchio (Carpentier et al. 2019) under DOP853: its constraint dynamics with the proximal solver and Baumgarte's gains, no simulator.
// A setting is TOLERANCE:OMEGA, gains 2 omega and omega^2, or TOLERANCE:OMEGA:MU with another regularisation than 1e-9; `cost` measures
// set-up and an evaluation.
#include <pinocchio/algorithm/aba.hpp>
#include <pinocchio/algorithm/constrained-dynamics.hpp>
#include <pinocchio/algorithm/kinematics.hpp>
#include <pinocchio/multibody.hpp>

#include <cmath>
#include <memory>

#include "dop853.h"
#include "problem.h"

namespace pin = pinocchio;
using Eigen::Matrix3d;
using Eigen::Vector3d;
using Eigen::VectorXd;

static Vector3d vector(const Three &x) { return {x[0], x[1], x[2]}; }

struct Machine {
    Problem problem;
    pin::Model model;
    std::unique_ptr<pin::Data> data;
    std::vector<pin::RigidConstraintModel> constraints;
    std::vector<pin::RigidConstraintData> constraint_data;
    pin::ProximalSettings proximal;
    std::vector<size_t> joint;
    VectorXd tau, q, v;

    Machine(const Problem &p, double omega, double mu) : problem(p), proximal(1e-13, mu, 20) {
        model.gravity.linear(vector(p.gravity));
        for (size_t i = 0; i < p.bodies.size(); ++i) {
            const Body &b = p.bodies[i];
            const pin::SE3 at(Matrix3d::Identity(), vector(b.at));
            const size_t parent = b.parent < 0 ? 0 : joint[size_t(b.parent)];
            const Vector3d axis = vector(b.axis);
            const std::string name = "j" + std::to_string(i);
            size_t id;
            if (b.slides) id = model.addJoint(parent, pin::JointModelPrismaticUnaligned(axis), at, name);
            else if (axis == Vector3d::UnitX()) id = model.addJoint(parent, pin::JointModelRX(), at, name);
            else if (axis == Vector3d::UnitY()) id = model.addJoint(parent, pin::JointModelRY(), at, name);
            else if (axis == Vector3d::UnitZ()) id = model.addJoint(parent, pin::JointModelRZ(), at, name);
            else id = model.addJoint(parent, pin::JointModelRevoluteUnaligned(axis), at, name);
            joint.push_back(id);
            model.appendBodyToJoint(id, pin::Inertia(b.mass, vector(b.com), vector(b.inertia).asDiagonal()), pin::SE3::Identity());
        }
        for (const Loop &c : p.loops) {
            for (int k = 0; k < (p.plane ? 1 : 2); ++k) {
                const auto at = [&](const Three &x) { return pin::SE3(Matrix3d::Identity(), vector(x) + k * vector(c.axis)); };
                pin::RigidConstraintModel m(pin::CONTACT_3D, model, of(c.a), at(c.at_a), of(c.b), at(c.at_b), pin::LOCAL);
                m.baumgarte_corrector_parameters() = pin::BaumgarteCorrectorParametersTpl<double>(omega * omega, 2 * omega);
                constraints.push_back(m);
            }
        }
        data = std::make_unique<pin::Data>(model);
        for (const auto &m : constraints) constraint_data.push_back(m.createData());
        if (!constraints.empty()) pin::initConstraintDynamics(model, *data, constraints, constraint_data);
        const long n = model.nv;
        tau = q = v = VectorXd::Zero(n);
        for (size_t i = 0; i < p.bodies.size(); ++i) {
            q[long(i)] = p.bodies[i].q;
            v[long(i)] = p.bodies[i].v;
        }
    }

    size_t of(int body) const { return body < 0 ? 0 : joint[size_t(body)]; }

    Vector3d point(int body, const Three &at) const { return body < 0 ? vector(at) : Vector3d(data->oMi[of(body)].act(vector(at))); }

    // Velocity of a point, world axes.
    Vector3d rate(int body, const Three &at) const {
        if (body < 0) return Vector3d::Zero();
        const auto &own = data->v[of(body)];
        return data->oMi[of(body)].rotation() * (own.linear() + own.angular().cross(vector(at)));
    }

    // Accelerations of a state.
    void operator()(const VectorXd &y, VectorXd &dy) {
        const long n = model.nv;
        q = y.head(n);
        v = y.tail(n);
        for (size_t i = 0; i < problem.bodies.size(); ++i) tau[long(i)] = problem.bodies[i].torque - problem.bodies[i].damping * v[long(i)];
        if (!problem.springs.empty()) pull();
        dy.head(n) = v;
        if (constraints.empty()) dy.tail(n) = pin::aba(model, *data, q, v, tau);
        else dy.tail(n) = pin::constraintDynamics(model, *data, q, v, tau, constraints, constraint_data, proximal);
    }

    // Torques of the springs, by walking up the tree from each end.
    void pull() {
        pin::forwardKinematics(model, *data, q, v);
        for (const Spring &s : problem.springs) {
            const Vector3d a = point(s.a, s.at_a), b = point(s.b, s.at_b), d = b - a;
            const double length = d.norm();
            const Vector3d way = d / length;
            const double force = s.stiffness * (length - s.length) + s.damping * way.dot(rate(s.b, s.at_b) - rate(s.a, s.at_a));
            push(s.a, a, force * way);
            push(s.b, b, -force * way);
        }
    }

    void push(int body, const Vector3d &at, const Vector3d &force) {
        for (int i = body; i >= 0; i = problem.bodies[size_t(i)].parent) {
            const auto &place = data->oMi[of(i)];
            const Vector3d axis = place.rotation() * vector(problem.bodies[size_t(i)].axis);
            tau[i] += problem.bodies[size_t(i)].slides ? axis.dot(force) : axis.dot((at - place.translation()).cross(force));
        }
    }
};

int main(int count, char **words) {
    const Problem problem = read_problem(words[1]);
    for (int k = 2; k < count; ++k) {
        const std::string setting = words[k];
        if (setting == "cost") {
            double begin = now();
            Machine machine(problem, 0, 1e-9);
            const double built = now() - begin;
            VectorXd y(2 * machine.model.nv), dy(y.size());
            y << machine.q, machine.v;
            double best = 1e9;
            for (int r = 0; r < 20; ++r) {
                begin = now();
                machine(y, dy);
                best = std::min(best, now() - begin);
            }
            print_run(setting, built, {best});
            continue;
        }
        double tolerance, omega, mu = 1e-9;
        char colon;
        std::istringstream(setting) >> tolerance >> colon >> omega >> colon >> mu;
        Machine machine(problem, omega, mu);
        VectorXd y(2 * machine.model.nv);
        y << machine.q, machine.v;
        const double begin = now();
        const bool ended = dop853(machine, y, problem.end, tolerance, begin + 20);
        const double spent = now() - begin;
        std::vector<double> measured;
        if (ended) {
            machine.q = y.head(machine.model.nv);
            pin::forwardKinematics(machine.model, *machine.data, machine.q);
            for (const Measure &m : problem.measures) {
                if (m.kind == "point") measured.push_back(machine.point(m.body, m.place)[m.coordinate]);
                else measured.push_back(y[m.body + (m.kind == "v" ? machine.model.nv : 0)]);
            }
        }
        print_run(setting, spent, measured);
    }
}
