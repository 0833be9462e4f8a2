# Names and labels that a version has changed, old to new; tests/same_results applies them to what BEFORE wrote.
s/the arm is led through reach, grasp and lift, and a network learns by back-propagation to do it alone/the arm is guided through reach, grasp and lift, and a network learns by back-propagation to do it alone/
s/Lessons, each after [^;]* so far; the one thing/Iterations of training, each after an evaluation of what has been learned; the one thing/
s/Times that the arm is led in a lesson, each from another start/Demonstrations in an iteration, each from another start/
s/Times that all of them are gone through\./Epochs: how often an iteration learns from each of them./
s/Demonstrations of a step of learning\./Demonstrations in a gradient step./
s/Size of a step of learning, of Adam\./Learning rate of Adam./
s/Lessons after which the step has half that size, and a third/Iterations after which the rate is half, and a third/
s/Steps of learning over which the network is averaged before it [^;]*; 1:/Gradient steps over which the network is averaged; 1:/
s/Lessons until the network leads itself fully in a lesson's last demonstration, 0/Iterations until the network alone acts in the last demonstration of an iteration, 0/
s/as far as it can; lives in rapier, so/as far as it can; runs in rapier, so/
# The viewer of pages: a trial was a life. The key of the data is the format's and stays.
s/"lives":/"LIVESKEY":/g
s/\bpage\.lives\b/page.LIVESKEY/g
s/\blifeOf\b/trialOf/g
s/\bshowLives\b/showTrials/g
s/\blives\b/trials/g
s/\blife\b/trial/g
s/\bLife\b/Trial/g
s/LIVESKEY/lives/g
s/What is wanted of a whole trial, once\./Once for each trial./
s/by any weights or by mirrored ones, beside Braitenberg's vehicles/by any weights or by mirrored ones, compared with Braitenberg's vehicles/
s/are told by colour, others/are shown by colour, others/
s/of what tells them apart/of what differs/
s/wheels that do exactly what they are told/wheels that do exactly what is commanded/
s/enough for what the results tell, in minutes/enough for what the results show, in minutes/
s/Who shares the displacements; shared by/Which individuals share the displacements; shared by/
s/Whose dynamics: ours, or rapier's, which knows no sweeps, slip, limit frequency, stiffness and damping of contacts\./Physics: ours, or rapier's, which has no sweeps, slip, limit frequency, stiffness and damping of contacts./
s/Dynamics steps per control step; 4 is the least at which no bound of the physics is broken in 10\^6 random steps\./Dynamics steps per control step. 4 is the least at which no bound of the physics is broken in 10^6 random steps./
s/J1\.\.J4 at the start, trial after trial; J5\.\.J7 and the hand start at 0 (chosen)\./J1..J4 at the start, trial after trial; J5..J7 and the hand start at 0 (chosen)./
s/(tx, ty) of the sphere at the start, trial after trial; pose k goes with position k (chosen)\./(tx, ty) of the sphere at the start, trial after trial. Pose k goes with position k (chosen)./
s/How tx and ty lie in the world: forward X = ty, Y = tx; icub X = -tx, Y = -ty reverses the pairing with the poses\./Orientation of tx and ty in the world: forward X = ty, Y = tx, icub X = -tx, Y = -ty, which reverses the pairing with the poses./
s/Largest displacement of a joint at the start; uniform, on all 27 joints, clamped into their ranges (chosen)\./Largest displacement of a joint at the start, uniform, on all 27 joints, clamped into their ranges (chosen)./
s/Largest displacement of the sphere at the start along x and y; uniform (chosen)\./Largest displacement of the sphere at the start along x and y, uniform (chosen)./
s/Which individuals share the displacements; shared by a generation, its individuals are compared on equal terms\./Individuals that share the displacements. Sharing by a generation compares its individuals on equal terms./
s/Where the axes of J1\.\.J3 meet; the highest place from which the far sphere is still reached\./Intersection of the axes of J1..J3, the highest place from which the far sphere is in reach./
s/Moment arm of the muscles: 3 N m on most joints hold every posture of the task; 1 m reads N as N m\./Moment arm of the muscles: 3 N m on most joints hold every posture of the task. 1 m reads N as N m./
s/Further factor on the passive tension of the original program's muscles; its value there is not known to us\./Further factor on the passive tension of the original program's muscles. Its value there is not published./
s/sphere's centre relative to the palm's, x, y, z \[cm\]/sphere's center relative to the palm's, x, y, z [cm]/
s/Control step; 0\.1 s is that of the source's other experiments on these robots\./Control step. 0.1 s is that of the source's other experiments on these robots./
s/Trials of an evaluation; a few, because a trial is the mean of many robots' luck already\./Trials of an evaluation. A few suffice, because a trial is already a mean over many robots./
s/Robots of the team, one genome in all of them; 10 fit into the nests and leave room to miss each other\./Robots of the team, one genome in all of them. 10 fit into the nests and leave room to miss each other./
s/How much the camera sees, around straight ahead: sectors of 36 degrees as the real e-puck's camera, or all around\./Field of view of the camera, around straight ahead: sectors of 36 degrees as the real e-puck's camera, or all around./
s/Rays by which each sector is searched; a sector reads the share of them that see its colour\./Rays in each sector. A sector reads the share of them that see its color./
s/Generations that are evaluated; enough for what the results show, in minutes\./Generations that are evaluated. Enough for what the results show, in minutes./
s/Individuals of a generation, of each population where there are two; a multiple of the parents\./Individuals of a generation, of each population where there are two. A multiple of the parents./
s/Probability that mutation hits a bit, which is then drawn anew; that of the runs in docs\/results\/swarm\.md, not compared over many runs\./Probability that mutation hits a bit, which is then drawn again. It is that of the runs in docs\/results\/swarm.md, and was not tuned./
s/Robots slide along what they run into; undone as in the original, chases were seen to end with both stuck a few centimetres apart\./Robots slide along obstacles. With `undone`, as in the original, chases can end with both stuck a few centimeters apart./
s/Hulls as near as this touch, which is capture; so do hulls that collided in the last step\./Hulls as near as this touch, which is capture. So do hulls that collided in the last step./
s/Nests; two, so that robots may part\./Nests. With two, robots can separate./
s/Radius of a nest; six of a robot's, so that ten robots fit with room to drive by\./Radius of a nest. Six of a robot's, so that ten robots fit with room to drive by./
s/What a robot earns at the end that is on a nest then\./Reward at the end of a robot on a nest./
s/What a robot earns at the end less its mean distance to the others, of the arena's diagonal; times this\./Reward at the end of a robot in the place of all others. It falls with the mean distance to the others, in parts of the arena's diagonal./
s/Generations that are evaluated; the one thing that a resumed run may change\./Generations that are evaluated. A resumed run may change it, and nothing else./
s/Individuals of a generation; 0 for 4 + 3 ln n of n genes\./Individuals of a generation. 0 for 4 + 3 ln n of n genes./
s/Trials of an evaluation; twelve have a part of the area each\./Trials of an evaluation. Twelve have a part of the area each./
s/Dynamics steps of a control step; with half as many the script fails in 2 of 32 trials\./Dynamics steps of a control step. With half as many the script fails in 2 of 32 trials./
s/Middle of the area in which the ball lies, forwards and leftwards of the body's centre\./Middle of the area of the ball, forwards and leftwards of the body's center./
s/Pitch, roll and yaw of the trunk at the start; roll is held there\./Pitch, roll and yaw of the trunk at the start. Roll is held there./
s/Flexion of each joint of the thumb, and of each of the other fingers, at output 1; 0 at output 0\./Flexion of each joint of the thumb, and of each of the other fingers, at output 1. It is 0 at output 0./
s/Horizontal field of view of the left eye; offsets count in its image's width\./Horizontal field of view of the left eye. Offsets count in its image's width./
s/Whether the head follows the ball by a reflex; without it the neck's angles stay as at the start\./The head follows the ball by a reflex. Without it the neck keeps its angles of the start./
s/How long the ball must be up, touched by the hand alone, at the end of a trial that succeeds\./Time for which the ball must be up, touched by the hand alone, at the end of a successful trial./
s/an e-puck pushes a box as far as it can; runs in rapier, so it needs a build with --features rapier/an e-puck pushes a box as far as it can, in rapier, which needs a build with --features rapier/
s/What moves robot and box: in the kinematic arena nothing is pushed\./Physics of robot and box: in the kinematic arena nothing is pushed./
s/How far the box must have come for a trial to be a success\./Displacement of the box in a successful trial./
s/fewer robots than evolved together; the others are not there/fewer robots than evolved together, without the others/
s/The fastest that a robot drives; the source's 500 mm\/s are a MarXbot's, the others keep their own\./Largest speed of a robot. The source's 500 mm\/s are a MarXbot's, and the others have the speed of their wheels./
s/Cells along a side of the arena; each has one piece of food, which the first robot there takes\./Cells along a side of the arena. Each has one piece of food, which the first robot there takes./
s/Energy that a step costs of the 1 that the nest gives; a robot without is dead, and its food is lost\./Energy that a step costs, of the 1 that the nest gives. A robot without energy is dead, and its food is lost./
s/Whether all generations have the same targets; where each has others, a network for these alone does not last\./All generations have the same targets. Other targets in each generation select against networks for a few of them./
s/Dynamics steps of a control step; tests compare with shorter ones\. Position servos that saturate swing where there are fewer than eight\./Dynamics steps of a control step. Tests compare with shorter ones. Position servos that saturate swing where there are fewer than eight./
s/Centre of the ellipsoid of targets, relative to the body's centre: in front of the left shoulder\./Center of the ellipsoid of targets, relative to the body's center: in front of the left shoulder./
s/Its semi-axes; targets are in its half that is in front of the centre, all of which six joints reach\./Its semi-axes. Targets are in its half in front of the center, all of which six joints reach./
s/Start distances below this count as this: most do, so that fitness is about the mean distance in parts of it; near targets would else weigh more than far ones\./Start distances below this count as this. Most are below, so fitness is about the mean distance in parts of it. Near targets would else weigh more than far ones./
s/The left arm's seven joints at the start, from the shoulder on; the wrist's three are held there\./The left arm's seven joints at the start, from the shoulder on. The wrist's three are held there./
s/the target's place relative to the body's centre/the target's place relative to the body's center/
s/Iterations of training, each after an evaluation of what has been learned; the one thing that a resumed run may change\./Iterations of training, each after an evaluation of the network. A resumed run may change it, and nothing else./
s/Demonstrations in an iteration, each from another start; the four trials take turns\./Demonstrations in an iteration, each from another start. The four trials take turns./
s/Gradient steps over which the network is averaged; 1: as the latest one left it\./Gradient steps over which the network is averaged. 1 takes the latest network./
s/Width of the line that the agent moves on; it stops at the ends\./Width of the line that the agent moves on. It stops at the ends./
s/Input of a ray that is cut at its origin; it falls linearly to 0 at the ray's end\./Input of a ray that is cut at its origin. It falls linearly to 0 at the ray's end./
s/Height of an object's centre above the agent's at the start\./Height of an object's center above the agent's at the start./
s/Starts of each trained instruction; six meet each order of the colours once\./Starts of each trained instruction. Six have each order of the colors once./
s/Their radius; both are capsules\./Their radius. Both are capsules./
s/How far each joint turns to each side\./Largest turn of each joint to either side./
s/Where the three objects stand, from the left to the right; which colour stands where is drawn\./Places of the three objects, from left to right. Their colors are drawn./
s/Whether that side is drawn: half of the starts are then stretched by the speed that folds the others\./That side is drawn. Half of the starts are then stretched by the speed that folds the others./
s/How much more than that costs all\./Distance beyond that at which the share falls to 0./
s/The same of the target of TOUCH: who loses all by a push does not learn to touch\./That distance for the target of TOUCH: an agent that loses all by a push does not learn to touch./
s/Distance of the tip from the centred target from which on TOUCH and MOVE earn something for reaching\./Distance of the tip from the centered target below which TOUCH and MOVE earn something for reaching./
s/What reaching counts in the acts of TOUCH and MOVE: without it no agent learned to stretch\./Weight of reaching in the acts of TOUCH and MOVE: without it no agent learned to stretch./
s/What IGNORE earns for a look past the target: without it a run of 20 000 generations looked at the target\./Reward of IGNORE for a look past the target: without it a run of 20 000 generations looked at the target./
s/{actions}: 1 for the one that is told/{actions}: 1 for the given one/
s/red, green, blue: 1 for the one that is told/red, green, blue: 1 for the given one/
s/two legs walk down a slope by themselves, beside the simplest walking model; nothing evolves/two legs walk down a slope by themselves, compared with the simplest walking model; nothing evolves/
s/Slope, falling ahead; gaits of the walking model are stable up to about 0\.015\./Slope, falling ahead. Gaits of the walking model are stable up to about 0.015./
s/Dynamics steps of a tick; a footfall needs some within its shortest time, stiffness\/damping\./Dynamics steps of a tick. A footfall needs some within its shortest time, stiffness\/damping./
s/Trials, each with a launch of its own\./Trials, each with its own launch./
s/Mass at the soles of each pair; the walking model is the limit of none\./Mass at the soles of each pair. The walking model is the limit of none./
s/Radius of the soles; the walking model is the limit of points\./Radius of the soles. The walking model is the limit of points./
s/How far the legs turn against each other, to each side: stops\./Largest turn of the legs against each other, to each side./
s/Damping ratio of the walker's mass on that stiffness; below about 3 the walker bounces off its footfalls\./Damping ratio of the walker's mass on that stiffness. Below about 3 the walker bounces off its footfalls./
s/How far the legs stand ahead and behind at the launch: a gene\./Angle of the legs ahead and behind at the launch: a gene./
s/Individuals of a generation, a multiple of the parents; with no more than them nothing is ever mutated\./Individuals of a generation, a multiple of the parents. With no more than them nothing is ever mutated./
s/Damping ratio of the walker's mass on that stiffness; below about 3 walkers bounce off their footfalls\./Damping ratio of the walker's mass on that stiffness. Below about 3 walkers bounce off their footfalls./
s/Angle of the first pole from upright at the start; all else is at rest in the middle\./Angle of the first pole from upright at the start. All else is at rest in the middle./
s/Steps of the network that a trial lasts; who balances both poles so long has succeeded\./Steps of the network in a trial. A network that balances both poles so long has succeeded./
s/What moves the robot: wheels that do exactly what is commanded, or rapier, where it has mass and its motors have a largest torque\./Physics of the robot: in `arena` its wheels turn exactly as commanded, in `rapier` it has mass and its motors a largest torque./
s/Steps of a trial; a collision ends it before\./Most steps of a trial. A collision ends it earlier./
s/Radius of the cylinder to stay at, and of the other one where there is one\./Radius of the cylinder to stay at, and of the other one./
s/Weights and biases are decoded from gene 0 at plus to the largest gene at minus this\./Weights and biases are decoded from plus this at gene 0 to minus this at the largest gene./
s/Model of the infrared sensors: a formula, rays, or measured tables as the source's; auto takes tables where they are named, else the formula, which needs no files\./Model of the infrared sensors: a formula, rays, or tables measured on a robot. `auto` reads tables if they are named and takes the formula if not./
s/Radius of the hull; swarms are of e-pucks of 0\.035 m\./Radius of the hull. E-pucks of swarms have 0.035 m./
s/Generations that are evaluated; the one thing that a resumed run may change\./Generations that are evaluated. A resumed run may change it, and nothing else./
s/The best individuals, which make population \/ parents copies each, the first of them unchanged\./The best individuals, which make population \/ parents copies each. The first copy is unchanged./
s/Least distance between the cylinders' surfaces: more than twice fitness\.near, so that nothing is near both\./Least distance between the cylinders' surfaces: more than twice fitness.near, so that no place is near both./
s/What a step near the other cylinder costs, in steps near the first; at 1, staying anywhere would gain nothing, and nothing evolved\./Cost of a step near the other cylinder, in steps near the first. With 1 staying anywhere gains nothing, and nothing evolved./
s/Side of the walled square in whose middle the lamp stands; wide, so that a vehicle that leaves is seen to\./Side of the walled square with the lamp in its middle. It is wide, to show where a vehicle goes that leaves the lamp./
s/Trials, each with a start of its own\./Trials, each with its own start./
s/Steps of a trial; collisions do not end it\./Steps of a trial. Collisions do not end it./
s/Distance from which a sensor that looks at the lamp reads 1; light falls with the distance's square\./Distance from which a sensor that looks at the lamp reads 1. Light falls with the distance's square./
s/Least and greatest distance from the robot's centre to the lamp's at the start; direction and heading are uniform\./Least and greatest distance from the robot's center to the lamp's at the start. Direction and heading are uniform./
s/Weight of each light sensor, plus (2a, 2b) or minus (3a, 3b), in parts of the greatest wheel speed\./Weight of each light sensor in shares of the greatest wheel speed, positive in 2a and 2b, negative in 3a and 3b./
s/Wheel speed in the dark, in parts of the greatest: a little where light drives, half where it slows\./Wheel speed in the dark, in shares of the greatest: a little where light drives the wheels, half where it slows them./
s/Generations of one parent and one mutant; the one thing that a resumed run may change\./Generations of one parent and one mutant. A resumed run may change it, and nothing else./
s/What happens to a bit that mutation hits: it is drawn anew, or it flips\./Change of a bit that mutation hits: it is drawn again, or it flips./
s/What happens to a bit that mutation hits: it flips, or it is drawn anew\./Change of a bit that mutation hits: it flips, or it is drawn again./
s/Nearest behaviours (k), whose/Nearest behaviors (k), whose/
s/Probability that a behaviour enters the archive/Probability that a behavior enters the archive/
s/How behaviours are divided into cells: a grid/Division of behaviors into cells: a grid/
