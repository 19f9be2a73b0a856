/// Two causes with the same regressor for every motion.
pub(crate) const TWINS: [(&str, &str, &str); 1] = [(
    "eccentric-mass",
    "gravity-tilt",
    "on one crank gravity on a mass off the axis and a tilted plane are the same force",
)];
