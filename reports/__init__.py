"""Tables and pictures. Takes data frames and images and knows no other room."""
