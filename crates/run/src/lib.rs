//! What the programs of moduli share.
