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
};
