//! Any bytes as the sidecar of a small log: a recording or a sentence.

const TABLE: &str = "trial,t_s,x_m,y_m,q_rad,fx_N,fy_N,force_N,label\n1,0,0.1,0.2,1,2,3,4,free\n1,1,0.2,0.3,2,3,4,5,free\n2,0,1,2,3,4,5,6,held\n";

pub fn run(bytes: &[u8]) {
    let path = crate::targets::file("log.csv");
    std::fs::write(path.with_file_name("log.meta.json"), bytes).expect("the temporary folder is writable");
    std::fs::write(&path, TABLE).expect("the temporary folder is writable");
    if let Err(error) = estimator::log::load(&path, None) {
        assert!(!error.to_string().is_empty());
    }
}
