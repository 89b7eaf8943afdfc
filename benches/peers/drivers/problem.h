// The problem as `problems.py` writes it, and how a driver is called: DRIVER PROBLEM SETTING...
#pragma once

#include <array>
#include <ctime>
#include <fstream>
#include <iostream>
#include <sstream>
#include <string>
#include <vector>

using Three = std::array<double, 3>;

struct Body {
    int parent;
    bool slides;
    Three axis, at;
    double mass;
    Three com, inertia;
    double q, v, damping, torque;
};

struct Loop {
    int a, b;
    Three at_a, at_b, axis;
};

struct Spring {
    int a, b;
    Three at_a, at_b;
    double stiffness, damping, length;
};

struct Measure {
    std::string kind;
    int body, coordinate;
    Three place;
};

struct Problem {
    bool plane;
    Three gravity;
    double end;
    std::vector<Body> bodies;
    std::vector<Loop> loops;
    std::vector<Spring> springs;
    std::vector<Measure> measures;
};

inline std::istream &operator>>(std::istream &in, Three &x) { return in >> x[0] >> x[1] >> x[2]; }

inline Problem read_problem(const std::string &path) {
    Problem p{};
    std::ifstream file(path);
    std::string line;
    while (std::getline(file, line)) {
        std::istringstream in(line);
        std::string what;
        in >> what;
        if (what == "plane") in >> p.plane;
        if (what == "gravity") in >> p.gravity;
        if (what == "end") in >> p.end;
        if (what == "body") {
            Body b{};
            std::string kind;
            in >> b.parent >> kind >> b.axis >> b.at >> b.mass >> b.com >> b.inertia >> b.q >> b.v >> b.damping >> b.torque;
            b.slides = kind == "slide";
            p.bodies.push_back(b);
        }
        if (what == "loop") {
            Loop c{};
            in >> c.a >> c.b >> c.at_a >> c.at_b >> c.axis;
            p.loops.push_back(c);
        }
        if (what == "spring") {
            Spring s{};
            in >> s.a >> s.b >> s.at_a >> s.at_b >> s.stiffness >> s.damping >> s.length;
            p.springs.push_back(s);
        }
        if (what == "measure") {
            Measure m{};
            in >> m.kind >> m.body >> m.coordinate >> m.place;
            p.measures.push_back(m);
        }
    }
    return p;
}

// Processor time of this process, s.
inline double now() {
    timespec t{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
    return double(t.tv_sec) + 1e-9 * double(t.tv_nsec);
}

// One line: what is printed of a run.
inline void print_run(const std::string &setting, double seconds, const std::vector<double> &measured) {
    std::cout.precision(17);
    std::cout << "{\"setting\": \"" << setting << "\", \"seconds\": " << seconds << ", \"measured\": [";
    for (size_t i = 0; i < measured.size(); ++i) std::cout << (i ? ", " : "") << measured[i];
    std::cout << "]}" << std::endl;
}
