//! What the world is made of: solids, materials, loads, contact.
