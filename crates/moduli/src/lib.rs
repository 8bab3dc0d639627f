//! From a scan of an object to grasps that a robot hand can execute.

pub mod records;
