//! moduli
