pln(16)         g10<1>F         g6<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
pln(16)         g12<1>F         g6.4<0,1,0>F    g2<8,8,1>F      { align1 1H compacted };
pln(16)         g117<1>F        g8<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
pln(16)         g119<1>F        g8.4<0,1,0>F    g2<8,8,1>F      { align1 1H compacted };
pln(16)         g121<1>F        g9<0,1,0>F      g2<8,8,1>F      { align1 1H compacted };
mov(1)          g48<1>D         1056964608D                     { align1 WE_all 1N };
mad.sat(16)     g18<1>F         g48.0<0,1,0>F   g48.0<0,1,0>F   g10<4,4,1>F { align16 1H };
mad.sat(16)     g29<1>F         g48.0<0,1,0>F   g48.0<0,1,0>F   g12<4,4,1>F { align16 1H };
mul(16)         g20<1>F         g18<8,8,1>F     0x457ff000F  /* 4095F */ { align1 1H };
mul(16)         g31<1>F         g29<8,8,1>F     0x457ff000F  /* 4095F */ { align1 1H };
rnde(16)        g22<1>F         g20<8,8,1>F                     { align1 1H compacted };
rnde(16)        g33<1>F         g31<8,8,1>F                     { align1 1H compacted };
mov(16)         g24<1>D         g22<8,8,1>F                     { align1 1H compacted };
mov(16)         g35<1>D         g33<8,8,1>F                     { align1 1H compacted };
shr(16)         g26<1>UD        g24<8,8,1>UD    0x00000004UD    { align1 1H compacted };
shl(16)         g28<1>D         g24<8,8,1>D     0x00000004UD    { align1 1H };
shr(16)         g37<1>UD        g35<8,8,1>UD    0x00000008UD    { align1 1H compacted };
mov(16)         g43<1>F         g35<32,8,4>UB                   { align1 1H };
mov(16)         g41<1>F         g26<32,8,4>UB                   { align1 1H };
or(16)          g39<1>UD        g28<8,8,1>UD    g37<8,8,1>UD    { align1 1H compacted };
mul(16)         g50<1>F         g43<8,8,1>F     0x3b808081F  /* 0.00392157F */ { align1 1H };
mul(16)         g46<1>F         g41<8,8,1>F     0x3b808081F  /* 0.00392157F */ { align1 1H };
mov(16)         g42<1>F         g39<32,8,4>UB                   { align1 1H };
mul(16)         g48<1>F         g42<8,8,1>F     0x3b808081F  /* 0.00392157F */ { align1 1H };
sendsc(16)      nullUD          g0UD            g46UD           0x040b0000                0x00000200
                            render MsgDesc: RT write SIMD16 Surface = 0 mlen 2 ex_mlen 8 rlen 0 { align1 1H };
mov(16)         g47<1>UD        g0<8,8,1>UD                     { align1 WE_all 1H compacted };
mov(1)          g47.2<1>UD      0x00000001UD                    { align1 WE_all 1N compacted };
sendsc(16)      nullUD          g47UD           g10UD           0x040b0001                0x00000200
                            render MsgDesc: RT write SIMD16 Surface = 1 mlen 2 ex_mlen 8 rlen 0 { align1 1H };
mov(16)         g125<1>UD       g0<8,8,1>UD                     { align1 WE_all 1H compacted };
mov(1)          g125.2<1>UD     0x00000002UD                    { align1 WE_all 1N compacted };
sendsc(16)      nullUD          g125UD          g117UD          0x040b1002                0x00000200
                            render MsgDesc: RT write SIMD16 LastRT Surface = 2 mlen 2 ex_mlen 8 rlen 0 { align1 1H EOT };
