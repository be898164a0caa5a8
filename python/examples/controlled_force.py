"""A stepper with a controller: a cube on a rough plane is pushed so that it keeps 0.2 m/s."""
import ballast

scene = ballast.Scene("sliding_cube")
cube = scene.names.index("cube")
wanted, gain = 0.2, 50.0  # [m/s], [N s/m]
speeds = []


def control(scene, record):
    speed = scene.velocities[cube, 0]
    speeds.append(float(speed))
    scene.set_force("cube", [3.924 + gain * (wanted - speed), 0.0, 0.0])


scene.step(500, control)
print("after %.2f s: %.4f m/s, first %.4f" % (scene.time, speeds[-1], speeds[0]))
