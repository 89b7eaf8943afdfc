// Models that the tests have beside those of models/.

export const MODELS = {
  // slide, slot of a sort, gears, springs and dampers in one picture; names that a page must not take for its own text
  signs: `grashof: 1
name: signs </script><b>&amp;
about: |
  Every sign at once.
space: planar
gravity: [0, -9.81 m/s^2]
ground: { O: [0, 0], W: [0, 0], S: [0, 30 cm] }
bodies:
  crank: { bar: { length: 10 cm, mass: 1 kg } }
  rod: { bar: { length: 30 cm, mass: 1 kg } }
  block: { mass: 1 kg }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, rod.start] }
  B: { revolute: [rod.end, block.origin] }
  P: { slider: [ground.W, block.origin], axis: [1, 0] }
springs:
  spring: { between: [ground.S, rod.end], stiffness: 100 N/m, damping: 2 N s/m, length: 20 cm }
drivers: { drive: { joint: O, speed: 60 rpm } }
start: { O.angle: 0 deg, P.position: ~40 cm }
studies:
  turn:
    about: '<img src=x onerror=alert(1)> & a turn'
    inverse: { over: 1 turn, samples: 90 }
  small:
    kinematics: { over: 1 turn, samples: 60 }
    columns: [O.angle, P.position]
    expect: { max(P.position): { is: 50 cm, within: 1 mm } }
`,
  // they travel far: in the plane on wheels, in space in the air
  car: `grashof: 1
name: car
space: planar
gravity: [0, -9.81 m/s^2]
bodies:
  chassis: { mass: 200 kg, drawn: [[-1 m, 0], [1 m, 0], [0.8 m, 0.4 m], [-0.8 m, 0.4 m]], points: { F: [0.7 m, 0], R: [-0.7 m, 0] } }
  front: { disc: { radius: 0.3 m, mass: 10 kg } }
  rear: { disc: { radius: 0.3 m, mass: 10 kg } }
joints:
  S: { slider: [ground, chassis.origin], axis: [1, 0] }
  F: { revolute: [chassis.F, front.origin] }
  R: { revolute: [chassis.R, rear.origin] }
couplings:
  rollF: { zero: front.angle + S.position/(0.3 m)*1 rad }
  rollR: { zero: rear.angle + S.position/(0.3 m)*1 rad }
loads: { push: { joint: S, force: 500 N } }
start: { S.position: 0 m, S.velocity: 2 m/s }
studies: { drive: { dynamics: { until: 4 s, every: 50 ms }, columns: [time, S.position], trace: [front.origin] } }
`,
  thrown: `grashof: 1
name: two bars thrown
space: spatial
gravity: [0, 0, -9.81 m/s^2]
bodies:
  a: { bar: { length: 20 cm, mass: 1 kg, width: 1 cm, height: 1 cm } }
  b: { bar: { length: 20 cm, mass: 1 kg, width: 1 cm, height: 1 cm } }
joints: { J: { revolute: [a.end, b.start], axis: [0, 0, 1] } }
start: { a.x: 0, a.y: 0, a.z: 1 m, a.vx: 8 m/s, a.vy: 3 m/s, a.vz: 6 m/s, J.angle: 60 deg, J.omega: 300 deg/s }
studies: { fly: { dynamics: { until: 1.5 s, every: 20 ms }, columns: [time, a.com.x] }, coarse: { dynamics: { until: 1 s, every: 0.1 s, integrator: newmark, alpha: 0.6, beta: 1, step: 50 ms }, scalars: { late: "value(a.com.x, 9 s)" } } }
`,
  // they hang from where they start, in the plane and in space
  ...Object.fromEntries([['hangs', 'planar', '[0, -9.81 m/s^2]', ''], ['hangs-in-space', 'spatial', '[0, 0, -9.81 m/s^2]', ', axis: [0, -1, 0]']].map(([name, space, gravity, axis]) => [name, `grashof: 1
name: ${name}
space: ${space}
gravity: ${gravity}
bodies:
  rod: { bar: { length: 1 m, mass: 1 kg } }
  bob: { bar: { length: 30 cm, mass: 1 kg } }
joints:
  P: { revolute: [ground, rod.start]${axis} }
  Q: { revolute: [rod.end, bob.start]${axis} }
start: { P.angle: -30 deg, Q.angle: 20 deg }
studies: { rest: { statics: { from: start }, columns: [P.angle, Q.angle] } }
`])),
  // its variable falls on the way
  clamp: `grashof: 1
name: clamp
space: planar
gravity: none
bodies: { handle: { bar: { length: 16 cm, mass: 0.3 kg } } }
joints: { A: { revolute: [ground, handle.start] } }
drivers: { hand: { joint: A, speed: -60 deg/s } }
start: { A.angle: 97 deg }
studies: { close: { inverse: { over: 60 deg, samples: 60 }, columns: [time, A.angle, handle.end], trace: [handle.end] } }
`,
  // more curves than colours, points beside them, and a curve that turns back
  swing: `grashof: 1
name: swing
space: planar
gravity: [0, -9.81 m/s^2]
parameters: { l: 1 m }
bodies: { rod: { bar: { length: l, mass: 1 kg } } }
joints: { A: { revolute: [ground, rod.start] } }
start: { A.angle: -30 deg }
measures: { x: rod.end.x, y: rod.end.y }
studies:
  lengths:
    dynamics: { until: 1 s, every: 10 ms }
    sweep: { l: [0.2 m, 0.4 m, 0.6 m, 0.8 m, 1 m, 1.2 m, 1.4 m, 1.6 m, 1.8 m] }
    columns: [time, A.angle, x, y]
    plot:
      angle: { show: [A.angle], data: { seen: { file: seen.csv, x: time, y: A.angle, in: [s, deg] } } }
  path:
    dynamics: { until: 1.5 s, every: 10 ms }
    columns: [time, A.angle, x, y]
    plot: { height: { show: [y], over: x }, both: [x, y] }
`,
  // a crank so short that names of its ends have no room beside it
  short: `grashof: 1
name: short
space: planar
gravity: none
ground: { O: [0, 0], C: [60 cm, 0] }
bodies:
  crank: { bar: { length: 3 cm, mass: 1 kg } }
  rod: { bar: { length: 60 cm, mass: 1 kg } }
  rocker: { bar: { length: 30 cm, mass: 1 kg } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, rod.start] }
  B: { revolute: [rod.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
drivers: { drive: { joint: O, speed: 60 rpm } }
start: { O.angle: 0 deg, C.angle: ~100 deg }
studies: { turn: { kinematics: { over: 1 turn, samples: 90 }, columns: [time, O.angle, C.angle] } }
`,
  // a hinge of the ground that an outline and a disc cover
  covered: `grashof: 1
name: covered
space: planar
gravity: none
bodies:
  wheel: { disc: { radius: 20 cm, mass: 1 kg } }
  plate: { plate: { size: [50 cm, 60 cm], mass: 1 kg } }
joints: { O: { revolute: [ground, wheel.origin] }, W: { slider: [ground, plate.origin], axis: [1, 0] } }
drivers: { turn: { joint: O, speed: 60 rpm }, hold: { joint: W, position: 0 m } }
studies: { turn: { kinematics: { over: 1 s, samples: 36 }, columns: [O.angle] } }
`,
  // a force upwards at the highest place, beside small ones
  pushed: `grashof: 1
name: pushed
space: planar
gravity: none
bodies:
  lever: { bar: { length: 1 m, mass: 1 kg } }
joints: { O: { revolute: [ground, lever.start] } }
drivers: { turn: { joint: O, speed: 15 rpm } }
start: { O.angle: 60 deg }
loads: { push: { at: lever.end, force: [20 N, 100 N] } }
studies: { turn: { inverse: { over: 1 s, samples: 36 }, show: [loads, reactions], columns: [O.angle] } }
`,
  // a pinion between a wheel and a rack, with numbers of teeth as 4 to 11, and two wheels without such numbers
  train: `grashof: 1
name: train
space: planar
gravity: none
ground: { O: [0, 0], P: [15 cm, 0], S: [0, -4 cm], Q: [40 cm, 0], R: [60 cm, 0] }
bodies:
  pinion: { disc: { radius: 4 cm, mass: 1 kg } }
  wheel: { disc: { radius: 11 cm, mass: 1 kg } }
  bar: { plate: { size: [30 cm, 3 cm], mass: 1 kg } }
  one: { disc: { radius: 8 cm, mass: 1 kg } }
  other: { disc: { radius: 8 cm, mass: 1 kg } }
joints:
  O: { revolute: [ground.O, pinion.origin] }
  P: { revolute: [ground.P, wheel.origin] }
  S: { slider: [ground.S, bar.origin], axis: [1, 0] }
  Q: { revolute: [ground.Q, one.origin] }
  R: { revolute: [ground.R, other.origin] }
couplings:
  pair: { gear: [O, P], ratio: -4/11 }
  teeth: { rack: [O, S], radius: 4 cm }
  uneven: { gear: [Q, R], ratio: -sqrt(2) }
  same: { zero: Q.angle - O.angle }
drivers: { drive: { joint: O, speed: 60 rpm } }
start: { O.angle: 0 deg, P.angle: 10 deg, S.position: 0 m, Q.angle: 0 deg, R.angle: 0 deg }
studies: { turn: { kinematics: { over: 1 turn, samples: 90 }, columns: [time, O.angle] } }
`,
  // a clamp, which transmits a moment
  cantilever: `grashof: 1
name: cantilever
space: planar
gravity: none
ground: { W: [0, 0] }
bodies: { beam: { bar: { length: 2 m, mass: 1 kg } } }
joints: { wall: { fixed: [ground.W, beam.start] } }
loads: { tip: { at: beam.end, force: [0, -50 N] } }
studies: { rest: { statics: { from: start }, show: [reactions], columns: [wall.m] } }
`,
  // a rope, springs over one coordinate, a torque, forces with a scale of their own, two vertical axes, measured data
  winch: `grashof: 1
name: winch
space: planar
gravity: [0, -9.81 m/s^2]
ground: { D: [0, 0], W: [10 cm, -40 cm], S: [40 cm, -40 cm] }
bodies:
  drum: { disc: { radius: 10 cm, mass: 3 kg } }
  weight: { plate: { size: [12 cm, 12 cm], mass: 4 kg } }
  block: { plate: { size: [8 cm, 8 cm], mass: 1 kg } }
joints:
  D: { revolute: [ground.D, drum.origin] }
  W: { slider: [ground.W, weight.origin], axis: [0, 1] }
  S: { slider: [ground.S, block.origin], axis: [0, 1] }
couplings: { rope: { rope: [D, W], radius: 10 cm } }
springs:
  coil: { joint: S, stiffness: 200 N/m }
  foot: { stretch: weight.y + 40 cm, stiffness: 20 N/m }
  spiral: { stretch: drum.angle, stiffness: 0.2 N m/rad }
loads: { brake: { joint: D, torque: -1 N m }, push: { at: block.origin, force: [0, 5 N] } }
start: { D.angle: 30 deg, W.position: 0 m, S.position: 2 cm }
measures: { height: W.position, speed: W.velocity }
studies:
  fall:
    dynamics: { until: 0.5 s, every: 5 ms }
    columns: [time, height, speed]
    show: { loads: 100 N/m, reactions: 200 N/m }
    plot:
      height:
        show: [height]
        right: { show: [speed], in: mm/s }
        data: { seen: { file: seen.csv, x: time, y: height, in: [s, mm] } }
`,
  // from dead point to dead point
  stuck: `grashof: 1
name: stuck
space: planar
gravity: [0, -9.81 m/s^2]
ground: { O: [0, 0], C: [40 cm, 0] }
bodies:
  crank: { bar: { length: 20 cm, mass: 1 kg } }
  coupler: { bar: { length: 25 cm, mass: 1 kg } }
  rocker: { bar: { length: 20 cm, mass: 1 kg } }
joints:
  O: { revolute: [ground.O, crank.start] }
  A: { revolute: [crank.end, coupler.start] }
  B: { revolute: [coupler.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start] }
drivers: { drive: { joint: O, speed: 60 rpm } }
start: { O.angle: 60 deg, coupler.angle: ~0 deg, rocker.angle: ~90 deg }
studies:
  turn:
    kinematics: { over: 1 turn, samples: 360 }
    columns: [O.angle, rocker.alpha, crank.omega, coupler.end.x, coupler.end.y]
    plot:
      alpha: { show: [rocker.alpha] }
      speed: { show: [crank.omega] }
      path: { show: [coupler.end.y], over: coupler.end.x }
`,
  // numbers of runs that have a pole or stand for no bound
  poles: `grashof: 1
name: poles
space: planar
gravity: none
parameters: { a: 1 }
bodies: { crank: { bar: { length: 50 cm, mass: 1 kg } } }
joints: { O: { revolute: [ground, crank.start] } }
drivers: { drive: { joint: O, speed: 60 rpm } }
start: { O.angle: 60 deg }
studies:
  turn:
    kinematics: { over: 1 turn, samples: 4 }
    sweep: { a: { from: 0, to: 10, count: 41 } }
    columns: [O.angle]
    scalars:
      pole: 1/(a - 5.1)
      both: if(a < 2, -1e30, if(a > 8, 1e30, sin(a)))
      one: if(abs(a - 4) < 0.01, 1e30, sin(a))
      plain: sin(a)
    plot: { pole: { show: [pole] }, both: { show: [both] }, one: { show: [one] }, plain: { show: [plain] } }
`,
  // forces that grow without bound towards dead points at both ends
  slant: `grashof: 1
name: slant
space: spatial
gravity: [0, 0, -9.81 m/s^2]
ground: { O: [0, 0, 0], C: [30 cm, 20 cm, 5 cm] }
bodies:
  crank: { bar: { length: 8 cm, width: 1 cm, height: 1 cm, mass: 0.3 kg } }
  rod: { bar: { length: 35 cm, width: 1 cm, height: 1 cm, mass: 0.8 kg } }
  rocker: { bar: { length: 20 cm, width: 1 cm, height: 1 cm, mass: 0.6 kg } }
joints:
  O: { revolute: [ground.O, crank.start], axis: [0, 0, 1] }
  A: { universal: [crank.end, rod.start], axes: [[0, 0, 1], [0, 1, 0]] }
  B: { spherical: [rod.end, rocker.end] }
  C: { revolute: [ground.C, rocker.start], axis: [1, 0, 0], to: [0, 0, 1] }
drivers: { drive: { joint: O, speed: 90 rpm } }
start: { O.angle: 0 deg, C.angle: ~90 deg }
studies:
  turn:
    inverse: { over: 1 turn, samples: 180 }
    columns: [O.angle, C.angle, C.omega, drive, A]
    plot: { torque: [drive.torque] }
`,
  // a study without results before one with some
  short_arm: `grashof: 1
name: short arm
space: planar
gravity: none
parameters: { l: 1 m }
bodies: { arm: { bar: { length: l, mass: 1 kg } } }
joints: { O: { revolute: [ground, arm.start] } }
drivers: { drive: { joint: O, speed: 60 rpm } }
start: { O.angle: 0 deg }
studies:
  far:
    about: It does not reach so far.
    kinematics: { over: 1 turn, samples: 12 }
    scalars: { reach: max(arm.end.x) }
    solve: { vary: l, between: [1 m, 2 m], target: { reach: 5 m } }
  turn: { kinematics: { over: 1 turn, samples: 12 }, columns: [O.angle] }
`,
  // numbers with long equal digits, far from 1, and an axis that ends within its curve
  digits: `grashof: 1
name: digits
space: planar
gravity: [0, -9.81 m/s^2]
bodies: { rod: { bar: { length: 1 m, mass: 1 kg } } }
joints: { A: { revolute: [ground, rod.start] } }
start: { A.angle: -30 deg }
measures:
  nearly: 30 deg + 1e-10*A.angle
  spike: 1/(1.001 + sin(A.angle))
  tiny: 1e-17 m*cos(A.angle)
  large: 3e7 N*cos(A.angle)
  shift: 2 m + 1e-6 m*cos(A.angle)
studies:
  swing:
    dynamics: { until: 1 s, every: 10 ms }
    columns: [time, nearly, spike, tiny, large, shift]
    plot:
      nearly: [nearly]
      spike: { show: [spike], y: { from: 0, to: 20 } }
      tiny: [tiny]
      shift: [shift]
      both: { show: [nearly], right: { show: [large] } }
      path: { show: [tiny], over: nearly }
`,
  // a ring around a sun, and two bars that cross
  crossing: `grashof: 1
name: crossing
space: planar
gravity: none
ground: { O: [0, 0], P: [25 cm, 0], Q: [45 cm, 0] }
bodies:
  sun: { disc: { radius: 3 cm, mass: 1 kg } }
  ring: { mass: 3 kg, inertia: 0.02 kg m^2, drawn: { circle: 12 cm } }
  one: { bar: { length: 30 cm, mass: 1 kg }, points: { mid: [15 cm, 0] } }
  two: { bar: { length: 30 cm, mass: 1 kg }, points: { mid: [15 cm, 0] } }
joints:
  S: { revolute: [ground.O, sun.origin] }
  R: { revolute: [ground.O, ring.origin] }
  P: { revolute: [ground.P, one.start] }
  M: { revolute: [one.mid, two.mid] }
  W: { pin-in-slot: [ground.Q, two.start], axis: [1, 0] }
couplings: { same: { zero: S.angle - P.angle }, back: { zero: R.angle + P.angle } }
drivers: { drive: { joint: P, speed: 10 deg/s } }
start: { P.angle: 20 deg, S.angle: 20 deg, R.angle: -20 deg, two.angle: ~160 deg }
studies: { lift: { kinematics: { over: 20 deg, samples: 20 }, columns: [time, P.angle] } }
`,
  // seen from above, and at a place of its motion that no frame has by itself
  door: `grashof: 1
name: door
space: spatial
ground: { H: [0, 0, 0] }
gravity: none
bodies: { leaf: { box: { size: [80 cm, 4 cm, 200 cm], mass: 20 kg }, points: { edge: [-40 cm, 0, 0] } } }
joints: { H: { revolute: [ground.H, leaf.edge], axis: [0, 0, 1] } }
drivers: { open: { joint: H, speed: 1 rad/s } }
start: { H.angle: 0 deg }
studies:
  open: { kinematics: { over: 100 deg, samples: 20 }, columns: [H.angle], view: top, at: 37 deg }
`,
  // a plate that rests elsewhere than it starts
  tray: `grashof: 1
name: tray
space: planar
gravity: [0, -9.81 m/s^2]
ground: { O: [0, 0] }
bodies: { plate: { mass: 5 kg, com: [20 cm, -10 cm], inertia: 0.5 kg m^2, points: { pa: [40 cm, 20 cm], pb: [60 cm, -20 cm], pc: [10 cm, -30 cm] } } }
joints: { O: { revolute: [ground.O, plate.origin] } }
springs: { s: { joint: O, stiffness: 20 N m/rad, rest: 0 deg } }
start: { O.angle: 60 deg }
studies: { rest: { statics: { from: start }, columns: [O.angle] } }
`,
  // stops of a slide, and with a variant of a hinge
  marks: `grashof: 1
name: marks
space: planar
gravity: none
ground: { W: [0, 0] }
bodies: { block: { plate: { size: [10 cm, 4 cm], mass: 1 kg } } }
joints: { W: { slider: [ground.W, block.origin], axis: [1, 0], limits: { from: -6 cm, to: 6 cm, restitution: 0.8 } } }
start: { W.velocity: 0.5 m/s }
variants:
  hinge:
    bodies: { block: { plate: null, bar: { length: 20 cm, mass: 1 kg } } }
    joints: { W: { slider: null, axis: null, revolute: [ground.W, block.start], limits: { from: -120 deg, to: 20 deg, restitution: 0.8 } } }
    start: { W.velocity: null, W.omega: 1 rad/s }
studies:
  slide: { dynamics: { until: 1 s, every: 5 ms }, columns: [time, W.position] }
  hinge: { variant: hinge, dynamics: { until: 1 s, every: 5 ms }, columns: [time] }
`,
  // what holds joints: one sign to a study
  held: `grashof: 1
name: held
space: planar
gravity: none
ground: { A: [0, 0], B: [1 m, 0] }
bodies: { left: { disc: { radius: 20 cm, mass: 1 kg } }, right: { disc: { radius: 20 cm, mass: 1 kg } } }
joints: { A: { revolute: [ground.A, left.origin] }, B: { revolute: [ground.B, right.origin] } }
start: { A.omega: 1 rad/s, B.omega: 0 rad/s }
variants:
  apart: { clutches: { it: { between: [A, B], torque: 1 N m } } }
  together: { ground: { B: [0, 0] }, clutches: { it: { between: [A, B], torque: 1 N m } } }
  brake: { clutches: { it: { joint: A, torque: 1 N m } } }
  shoe: { joints: { A: { revolute: null, slider: [ground.A, left.origin], axis: [1, 0] } }, start: { A.omega: null, A.velocity: 0.1 m/s }, clutches: { it: { joint: A, force: 1 N } } }
  shaft: { springs: { it: { stretch: B.angle - A.angle, stiffness: 1 N m/rad } } }
studies:
  none: { dynamics: { until: 0.1 s, every: 10 ms }, columns: [time] }
  apart: { variant: apart, dynamics: { until: 0.1 s, every: 10 ms }, columns: [time] }
  together: { variant: together, dynamics: { until: 0.1 s, every: 10 ms }, columns: [time] }
  brake: { variant: brake, dynamics: { until: 0.1 s, every: 10 ms }, columns: [time] }
  shoe: { variant: shoe, dynamics: { until: 0.1 s, every: 10 ms }, columns: [time] }
  shaft: { variant: shaft, dynamics: { until: 0.1 s, every: 10 ms }, columns: [time] }
`,
  // a cylinder that is driven out
  sleeve: `grashof: 1
name: sleeve
space: planar
gravity: none
ground: { C: [0, 0] }
bodies: { barrel: { bar: { length: 70 cm, mass: 12 kg } }, rod: { bar: { length: 70 cm, mass: 6 kg } } }
joints: { C: { revolute: [ground.C, barrel.start] }, cyl: { slider: [barrel.start, rod.start], axis: [1, 0] } }
drivers: { pump: { joint: cyl, rise: { by: 45 cm, during: 2 s, law: poly5 } }, hold: { joint: C, angle: 0 deg } }
start: { cyl.position: 20 cm, C.angle: 0 deg }
studies: { out: { inverse: { over: 2 s, samples: 50 }, columns: [time, cyl.position] } }
`,
  // a sweep of three runs
  sizes: `grashof: 1
name: sizes
space: planar
gravity: none
parameters: { l: 10 cm }
bodies: { bar: { bar: { length: l, mass: 1 kg } } }
joints: { O: { revolute: [ground, bar.start] } }
drivers: { turn: { joint: O, speed: 60 rpm } }
start: { O.angle: 0 deg }
studies:
  sizes:
    kinematics: { over: 90 deg, samples: 10 }
    sweep: { l: [5 cm, 10 cm, 20 cm] }
    columns: [O.angle, bar.end.x]
    scalars: { reach: max(bar.end.x) }
    plot: { reach: [reach], path: [bar.end.x] }
`,
  // lengths in mm, a parameter in a unit of its own
  leaf: `grashof: 1
name: leaf
space: planar
gravity: [0, -9.81 m/s^2]
units: [mm]
parameters: { k: 2 N/cm, l: 50 cm }
ground: { W: [0, 0] }
bodies:
  block: { mass: 0.5 kg, inertia: 1 kg cm^2 }
  rod: { bar: { length: l, mass: 0.5 kg } }
joints:
  S: { slider: [ground.W, block.origin], axis: [1, 1] }
  P: { revolute: [block.origin, rod.start] }
springs: { s: { joint: S, stiffness: k, damping: 3 N s/m } }
start: { S.position: ~0 mm, P.angle: ~-60 deg }
studies:
  rest: { statics: { from: start } }
  modes: { modes: { at: statics } }
  damped: { modes: { at: statics, damped: true } }
`,
  behind: `grashof: 1
name: behind
space: spatial
gravity: none
ground: { F: [0, -1 m, 0], B: [20 cm, 1 m, 0] }
bodies: { near: { plate: { size: [1 m, 10 cm, 1 m], mass: 1 kg } }, back: { plate: { size: [50 cm, 10 cm, 50 cm], mass: 1 kg } } }
joints: { F: { revolute: [ground.F, near.origin], axis: [0, 1, 0] }, B: { revolute: [ground.B, back.origin], axis: [0, 1, 0] } }
start: { F.omega: 0, B.omega: 0 }
studies: { rest: { dynamics: { until: 1 s }, view: front } }
`,
};

/** Files beside these models. */
export const FILES = { swing: { 'seen.csv': 'time,A.angle\n0.1,-35\n0.3,-60\n0.5,-90\n' }, winch: { 'seen.csv': 'time,height\n0.1,-20\n0.2,-90\n0.3,-210\n0.4,-380\n' } };

/** Models a study of which stops on its way. */
export const STOPPED = ['short_arm', 'stuck', 'slant'];

/** Models that are run with their figures. */
export const WITH_FIGURES = ['swing', 'digits', 'poles'];
