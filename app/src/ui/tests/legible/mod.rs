//! Tests of legibility by machine: no words over each other, nothing cut off but what can be scrolled to.

mod faults;
mod pages;
mod painted;
mod poses;
