//! Files of robots with joints.

use std::fmt::Write as _;

use super::Draw;

/// An arm of two joints.
const ARM: &str = r#"<robot name="arm"><link name="base"/>
<link name="upper"><inertial><origin xyz="0 0 0.1"/><mass value="1"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 0.1"/><geometry><cylinder radius="0.03" length="0.2"/></geometry></collision></link>
<link name="lower"><inertial><origin xyz="0 0 0.1"/><mass value="0.5"/><inertia ixx="0.01" iyy="0.01" izz="0.01" ixy="0" ixz="0" iyz="0"/></inertial>
<collision><origin xyz="0 0 0.1"/><geometry><sphere radius="0.05"/></geometry></collision></link>
<joint name="shoulder" type="revolute"><parent link="base"/><child link="upper"/><origin xyz="0 0 0.2"/><axis xyz="0 1 0"/><limit lower="-1" upper="1.5" effort="10" velocity="3"/></joint>
<joint name="elbow" type="revolute"><parent link="upper"/><child link="lower"/><origin xyz="0 0 0.2"/><axis xyz="0 1 0"/><limit lower="-1" upper="2" effort="5" velocity="3"/></joint></robot>"#;

/// A leg that hops near its floor's edge.
const HOPPER: &str = r#"<mujoco><worldbody><geom name="ground" type="plane" size="5 5 0.1"/>
<body name="upper" pos="0 0 0.7"><joint name="x" type="slide" axis="1 0 0"/><joint name="z" type="slide" axis="0 0 1"/><joint name="lean" axis="0 1 0"/>
<geom type="capsule" fromto="0 0 0.2 0 0 -0.2" size="0.05"/>
<body name="lower" pos="0 0 -0.2"><joint name="elbow" axis="0 1 0" range="-120 -5"/><geom type="capsule" fromto="0 0 0 0 0 -0.4" size="0.04"/></body></body></worldbody>
<actuator><motor name="knee motor" joint="elbow" ctrlrange="-1 1" forcerange="-40 40"/></actuator></mujoco>"#;

impl Draw {
    /// A file of a robot with joints that is right.
    pub(super) fn jointed(&mut self) -> String {
        let kind = self.stream.below(5);
        let (robot, body, joint, file) = match kind {
            0 => ("kind = \"arm-and-hand\"", "palm", "", None),
            1 | 2 => ("kind = \"model\"\nfile = \"m.xml\"", "lower", "elbow", Some(HOPPER)),
            _ => ("kind = \"model\"\nfile = \"m.xml\"", "lower", "elbow", Some(ARM)),
        };
        let mut text = format!("[world]\nengine = \"articulated\"\ntime_step = 0.02\n[robot]\n{robot}\n");
        if kind < 3 {
            text = text.replacen("0.02\n", "0.02\nfloor = false\n", 1);
        }
        let _ = writeln!(text, "[episode]\nsteps = 100\ntrials = 2\nends = [{}]", self.one(&["", "", "\"collision\""]));
        text += "[[objects]]\nname = \"there\"\nkind = \"marker\"\n";
        text += "[[start]]\nplace = \"there\"\nat = \"in-box\"\nlow = [-0.5, -0.5, 0.1]\nhigh = [0.5, 0.5, 0.5]\n";
        text += match self.stream.below(4) {
            0 => "[[objects]]\nname = \"thing\"\nkind = \"ball\"\nradius = 0.05\nmass = 0.3\nat = [0.6, 0.0, 0.1]\n",
            1 => "[[objects]]\nname = \"thing\"\nkind = \"block\"\nsize = [0.1, 0.2, 0.1]\nmass = 0.5\n",
            2 => "[[objects]]\nname = \"thing\"\nkind = \"marker\"\nat = [0.2, 0.3]\n",
            _ => "[[objects]]\nname = \"thing\"\nkind = \"ball\"\nradius = 0.04\nmass = 0.1\n",
        };
        if !text.contains("at = [") || text.contains("kind = \"block\"") {
            text += "[[start]]\nplace = \"thing\"\nat = \"in-box\"\nlow = [0.5, -0.3, 0.2]\nhigh = [0.9, 0.3, 0.3]\napart = 0.1\n";
        }
        if self.often(0.3) {
            text += "[[objects]]\nname = \"fence\"\nkind = \"wall\"\nsize = [0.1, 1.0]\nat = [1.2, 0.0]\n";
        }
        if !joint.is_empty() {
            let _ = writeln!(text, "[[start]]\nplace = \"{joint}\"\nat = \"turned\"\nlow = -0.6\nhigh = -0.2");
        }
        let joints = if joint.is_empty() { String::new() } else { format!("joints = [\"{joint}\"]\n") };
        let eye = format!(
            "{{ body = \"{body}\", at = [0.0, 0.0, 0.1], columns = 4, rows = 3, field_of_view = 70.0, range = 2.0 }}"
        );
        for _ in 0..=self.stream.below(4) {
            let sensor = match self.stream.below(14) {
                0 => format!("kind = \"joint-position\"\n{joints}"),
                1 => format!("kind = \"joint-speed\"\n{joints}"),
                2 => "kind = \"joint-position\"\nfrom = -1.0\nto = 1.0\n".into(),
                3 => "kind = \"touch\"\n".into(),
                4 => format!("kind = \"contact-force\"\nbodies = [\"{body}\"]\n"),
                5 => format!("kind = \"target-position\"\ntarget = \"there\"\nbody = \"{body}\"\n"),
                6 => "kind = \"target-position\"\ntarget = \"thing\"\naxes = \"world\"\n".into(),
                7 => format!("kind = \"body-pose\"\nbody = \"{body}\"\n"),
                8 => format!("kind = \"body-velocity\"\nbody = \"{body}\"\n"),
                10 => format!("kind = \"camera-image\"\neye = {eye}\n"),
                11 => format!(
                    "kind = \"color-blobs\"\neye = {eye}\ncolors = [{{ name = \"grey\", low = [0.4, 0.4, 0.4], high = [0.6, 0.6, 0.6] }}]\n"
                ),
                12 => format!("kind = \"visual-offset\"\neye = {eye}\nof = \"{body}\"\nfrom = \"{body}\"\n"),
                9 => "kind = \"height\"\npoint = [0.0, 0.0, 0.1]\n".into(),
                _ => "kind = \"constant\"\nvalue = 0.7\n".into(),
            };
            let _ = write!(text, "[[sensors]]\n{sensor}{}", self.wrappers(1));
        }
        let motor = match (kind, self.stream.below(4)) {
            (0, _) => "kind = \"muscles\"\n[[motors]]\nkind = \"servo\"\ntogether = true".into(),
            (1 | 2, 0) => "kind = \"joint-torque\"".into(),
            (_, 0) => format!("kind = \"joint-torque\"\n{joints}largest = 5.0"),
            (_, 1) => format!("kind = \"joint-velocity\"\n{joints}largest = 2.0\ngain = 3.0\nlimit = 4.0"),
            (_, 2) => format!("kind = \"servo\"\n{joints}stiffness = 20.0\ndamping = 1.0\nlimit = 10.0"),
            _ => format!("kind = \"muscles\"\n{joints}tension = 200.0\nmoment_arm = 0.02"),
        };
        let _ = write!(text, "[[motors]]\n{motor}\n{}", self.wrappers(1));
        text += &self.network(&text);
        let rewards = [
            "kind = \"distance\"\nobject = \"there\"".into(),
            format!("kind = \"near\"\nobject = \"thing\"\nwithin = 0.2\nbody = \"{body}\""),
            format!("kind = \"approach\"\nobject = \"thing\"\nover = \"end\"\nbody = \"{body}\""),
            "kind = \"touch\"\nweight = -0.5".into(),
            format!("kind = \"displacement\"\nover = \"most\"\nbody = \"{body}\""),
            "kind = \"moved\"\nobject = \"thing\"".into(),
            format!("kind = \"speed\"\nbody = \"{body}\""),
            format!("kind = \"forward\"\nbody = \"{body}\""),
            format!("kind = \"progress\"\nalong = [1.0, 0.0, 0.0]\nover = \"sum\"\nbody = \"{body}\""),
            format!("kind = \"position\"\nalong = [0.0, 1.0, 1.0]\nbody = \"{body}\""),
            format!("kind = \"height\"\nbody = \"{body}\"\npoint = [0.0, 0.0, -0.1]"),
            format!("kind = \"upright\"\nbody = \"{body}\""),
            "kind = \"joint-speed\"\nweight = -0.01".into(),
            "kind = \"effort\"".into(),
            "kind = \"control\"".into(),
            "kind = \"steps\"".into(),
        ];
        let first = self.stream.below(rewards.len() as u32) as usize;
        for number in 0..=(self.stream.below(3) as usize) {
            let _ = writeln!(text, "[[reward]]\n{}", rewards[(first + 4 * number) % rewards.len()]);
        }
        if let Some(model) = file {
            let _ = writeln!(text, "[files]\n\"m.xml\" = '''{model}'''");
        }
        text
    }
}
